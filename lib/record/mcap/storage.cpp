// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/storage.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <type_traits>

#include <hc/base/format.h>
#include <hc/base/text.h>
#include <hc/base/uri.h>

namespace hc::mcap {
namespace {

namespace fs = std::filesystem;

/// `kept_0001.mcap` for `kept.mcap`.
std::string numbered(const std::string& file, std::uint64_t number) {
  fs::path path(file);
  const auto stem = path.stem().string(), ending = path.extension().string();
  return path.replace_filename(hc::format("{}_{:04}{}", stem, number, ending)).string();
}

/// The highest number among the files of this name; 0: none.
std::uint64_t highest_number(const std::string& file) {
  const fs::path path(file);
  const auto folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string begin = path.stem().string() + "_";
  std::uint32_t highest = 0;
  std::error_code failed;
  fs::directory_iterator each(folder, failed);
  for (; !failed && each != fs::directory_iterator(); each.increment(failed)) {
    const std::string stem = each->path().stem().string();
    if (!stem.starts_with(begin) || each->path().extension() != path.extension()) continue;
    std::uint32_t number = 0;
    if (read_number(std::string_view(stem).substr(begin.size()), number))
      highest = std::max(highest, number);
  }
  return highest;
}

}  // namespace

Result<std::uint64_t> parse_bytes(std::string_view text) {
  constexpr NumberRange kRange{0, std::numeric_limits<std::int64_t>::max(), true};
  const auto bytes = number_option({"", "", {{"", std::string(text)}}}, "", 0, kRange);
  if (bytes) return static_cast<std::uint64_t>(*bytes);
  return Error{Code::Invalid,
               hc::format("\"{}\" is not a number of bytes, such as 1G (units K, M, G)", text)};
}

Result<Storage> Storage::make(const std::string& file, const StorageOptions& options) {
  if (options.keep > 0 && options.split == 0)
    return Error{Code::Invalid, "keep requires split: only whole files are removed"};
  if (options.last.count() > 0 && options.split > 0)
    return Error{Code::Invalid, "last and split exclude each other: memory is saved to one file"};
  Storage storage(file, options);
  if (options.last.count() == 0)
    if (auto begun = storage.begin_file(0); !begun) return begun.error();
  return storage;
}

/// A single file has the given name; files of a sequence are numbered.
Status Storage::begin_file(std::uint64_t time) {
  if (is_numbered()) number_ = std::max(number_, highest_number(name_)) + 1;
  auto file = File::create(is_numbered() ? numbered(name_, number_) : name_, options_.profile);
  if (!file) return file.error();
  file_ = std::move(*file);
  if (!is_numbered()) name_ = file_->path();
  for (const auto& each : repeated_)
    if (auto written = write(each, time); !written) return written;
  return {};
}

Status Storage::write(const Repeated& record, std::uint64_t time) {
  auto add = [&](const auto& each) {
    if constexpr (!std::is_same_v<decltype(each), const Lasting&>) {
      return file_->add(each);
    } else {
      ChunkBuilder chunk;
      const std::span<const std::byte> data[] = {each.data};
      chunk.add({each.channel, each.sequence, time, time}, data);
      return file_->add(chunk.pack());
    }
  };
  return std::visit(add, record);
}

std::vector<std::string> Storage::files() const {
  std::vector<std::string> files;
  for (const auto& each : done_) files.push_back(each.path);
  return files;
}

std::uint64_t Storage::messages() const {
  std::uint64_t all = 0;
  for (const auto& each : done_) all += each.messages;
  return all;
}

Status Storage::write(const Chunk& chunk) {
  auto added = file_->add(chunk);
  if (added) in_file_ += chunk.messages;
  return added;
}

Status Storage::end_file() {
  if (!file_) return {};
  auto closed = file_->close();
  done_.push_back({file_->path(), file_->size(), std::exchange(in_file_, 0)});
  file_.reset();
  return closed;
}

void Storage::remove_old() {
  std::uint64_t all = 0;
  for (const auto& each : done_) all += each.size;
  for (; !done_.empty() && all + options_.split > options_.keep; done_.pop_front()) {
    ::unlink(done_.front().path.c_str());
    all -= done_.front().size;
  }
}

void Storage::limit_lasting() {
  std::size_t all = 0;
  for (const auto& each : repeated_)
    if (const auto* lasting = std::get_if<Lasting>(&each))
      all += lasting->data.size() + kLastingOverhead;
  for (const bool also_known : {false, true})
    std::erase_if(repeated_, [&](const Repeated& each) {
      const auto* lasting = std::get_if<Lasting>(&each);
      if (all <= kMostLasting || lasting == nullptr || (!also_known && !lasting->about.empty()))
        return false;
      all -= lasting->data.size() + kLastingOverhead;
      return true;
    });
}

Status Storage::add(Repeated record) {
  if (const auto* metadata = std::get_if<MetadataRecord>(&record))
    std::erase_if(repeated_, [&](const Repeated& each) {
      const auto* older = std::get_if<MetadataRecord>(&each);
      return older != nullptr && older->name == metadata->name;
    });
  const auto* lasting = std::get_if<Lasting>(&record);
  if (lasting != nullptr)
    std::erase_if(repeated_, [&](Repeated& each) {
      auto* older = std::get_if<Lasting>(&each);
      if (older == nullptr || older->about.empty()) return false;
      for (const auto& one : lasting->about) older->about.erase(one);
      return older->about.empty();
    });
  auto added = file_ ? write(record, lasting != nullptr ? lasting->log_time : 0) : Status();
  repeated_.push_back(std::move(record));
  if (lasting != nullptr) limit_lasting();
  return added;
}

Status Storage::add(Chunk chunk) {
  if (file_ && options_.split > 0 && file_->size() >= options_.split) {
    if (auto ended = end_file(); !ended) return ended;
    if (options_.keep > 0) remove_old();
    if (auto begun = begin_file(chunk.begin); !begun) return begun;
  }
  if (file_) return write(chunk);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;  // [byte]
  const auto last = static_cast<std::uint64_t>(options_.last.count()), now = chunk.end;
  in_memory_ += chunk.bytes.size();
  memory_.push_back(std::move(chunk));
  while (memory_.size() > 1 && (memory_.front().end + last < now || in_memory_ > kMost)) {
    in_memory_ -= memory_.front().bytes.size();
    memory_.pop_front();
  }
  return {};
}

Result<std::string> Storage::save() {
  auto done = begin_file(memory_.empty() ? 0 : memory_.front().begin);
  const std::string name = file_ ? file_->path() : "";
  for (auto& chunk : memory_)
    if (done && (done = write(chunk))) chunk.messages = 0;  // a later file that has it, too
  if (auto ended = end_file(); done) done = ended;
  if (!done) return done.error();
  return name;
}

Status Storage::close() {
  return end_file();
}

}  // namespace hc::mcap
