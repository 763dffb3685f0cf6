// SPDX-License-Identifier: Apache-2.0
#include "folder.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <tuple>
#include <utility>

#include <sys/stat.h>

#include <hc/base/format.h>
#include <hc/module/kind.h>
#include <hc/mtp/codec.h>
#include <hc/mtp/stream_reader.h>
#include <hc/os/new_file.h>
#include <people/person_name.h>

namespace fs = std::filesystem;

using hc::people::Embedding;

namespace {

constexpr std::size_t kMostBytes = 1 << 20;  // of a file

hc::Result<std::vector<Embedding>> views_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  hc::StreamReader reader({.element_bytes = kMostBytes});
  hc::Message message;
  while (true) {
    if (HC_TRY(reader.next(message))) break;
    const auto space = reader.space();
    file.read(reinterpret_cast<char*>(space.data()), static_cast<std::streamsize>(space.size()));
    if (file.gcount() == 0) return hc::Error{hc::Code::Malformed, "it is no message"};
    reader.commit(static_cast<std::size_t>(file.gcount()));
  }
  const auto& header = message.header;
  constexpr auto kNumbers = std::tuple_size_v<Embedding>;
  const bool is_table = header.info.type == hc::MatrixType::Table &&
                        header.width == static_cast<std::int32_t>(kNumbers) && header.height > 0 &&
                        header.info.components == 1;
  if (!is_table) return hc::Error{hc::Code::Malformed, "it is no table with 128 columns"};
  const auto table = HC_TRY(hc::view<float>(message));
  std::vector<Embedding> views;
  for (std::size_t i = 0; i < table.height(); ++i) {
    std::ranges::copy(table.row(i), views.emplace_back().begin());
    if (!hc::people::is_embedding(views.back()))
      return hc::Error{hc::Code::Malformed, "it has numbers that no face has"};
  }
  return views;
}

/// Whether a name can be that of a file; hc::replace_private_file has others while it writes them.
bool is_file_name(std::string_view name) {
  return hc::people::is_person_name(name) && !name.ends_with(".unfinished");
}

}  // namespace

bool Folder::read() {
  if (path_.empty()) return false;
  std::map<std::string, hc::FileStamp> now;
  std::error_code failed;
  fs::directory_iterator each(path_, failed);
  for (; !failed && each != fs::directory_iterator(); each.increment(failed)) {
    const auto name = each->path().filename().string();
    std::error_code unknown;
    if (!is_file_name(name) || !each->is_regular_file(unknown)) continue;
    if (now.size() == kMostPeople) continue;
    now.emplace(name, hc::file_stamp(file_of(name)));
  }
  if (failed && failed != std::errc::no_such_file_or_directory) {
    complain(failed.message());
    return false;
  }
  complaint_.clear();
  if (now == files_) return false;
  for (const auto& [name, stamp] : files_)
    if (!now.contains(name)) gallery_.forget(name);
  for (const auto& [name, stamp] : now) {
    const auto known = files_.find(name);
    if (known != files_.end() && known->second == stamp) continue;
    gallery_.forget(name);
    if (const auto views = views_in(file_of(name)))
      gallery_.add(name, hc::people::mean(*views));
    else
      log_(hc::format("{} is ignored: {}", file_of(name), views.error().detail));
  }
  files_ = std::move(now);
  return true;
}

void Folder::complain(const std::string& why) {
  if (std::exchange(complaint_, why) != why)
    log_(hc::format("{} cannot be read, so known people stay as they are: {}", path_, why));
}

hc::Status Folder::learn(const std::string& name, const std::vector<Embedding>& views) {
  const auto refused = [](std::string why) { return hc::Error{hc::Code::Invalid, std::move(why)}; };
  if (!is_file_name(name))
    return refused("not a name: up to 64 bytes of UTF-8, without \"/\" and a dot at the beginning");
  if (path_.empty())
    return refused("no face can be learned without a folder: set the parameter people");
  if (::mkdir(path_.c_str(), S_IRWXU) != 0 && errno != EEXIST)
    return hc::Error{hc::Code::System, path_ + ": " + std::generic_category().message(errno)};
  std::vector<Embedding> all;
  std::error_code unknown;
  if (fs::exists(file_of(name), unknown)) {
    auto before = views_in(file_of(name));
    if (!before) return refused(file_of(name) + " is not a person's: " + before.error().detail);
    all = std::move(*before);
  } else if (files_.size() >= kMostPeople) {
    return refused(hc::format("{} people are known already", kMostPeople));
  }
  all.insert(all.end(), views.begin(), views.end());
  if (all.size() > kMostViews) all.erase(all.begin(), all.end() - kMostViews);
  std::vector<float> numbers;
  for (const auto& view : all) numbers.insert(numbers.end(), view.begin(), view.end());
  const auto message = hc::table<float>().message(
      static_cast<std::int32_t>(all.size()), static_cast<std::int32_t>(all[0].size()), numbers);
  HC_TRY(hc::replace_private_file(file_of(name), hc::encode(message)));
  read();
  return {};
}
