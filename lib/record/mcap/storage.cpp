// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/storage.h>

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include <hc/base/format.h>

namespace hc::mcap {
namespace {

namespace fs = std::filesystem;

/// `kept_0001.mcap` of `kept.mcap`.
std::string numbered(const std::string& file, std::uint64_t number) {
  fs::path path(file);
  const auto stem = path.stem().string(), ending = path.extension().string();
  return path.replace_filename(hc::format("{}_{:04}{}", stem, number, ending)).string();
}

/// The highest number that a file beside has; 0: there is none.
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
    const char* end = stem.data() + stem.size();
    const auto read = std::from_chars(stem.data() + begin.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end) highest = std::max(highest, number);
  }
  return highest;
}

}  // namespace

Result<std::uint64_t> parse_bytes(std::string_view text) {
  std::uint64_t number = 0;
  if (text.empty()) return number;
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, number);
  const std::string_view unit(stop, static_cast<std::size_t>(end - stop));
  const int shift = unit.empty() ? 0 : unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : -1;
  if (status != std::errc() || shift < 0 || number > std::uint64_t{1} << (63 - shift))
    return Error{Code::Invalid,
                 hc::format("\"{}\" is no number of bytes, such as 1G (of K, M and G)", text)};
  return number << shift;
}

Result<Storage> Storage::make(const StorageOptions& options) {
  if (options.keep > 0 && options.split == 0)
    return Error{Code::Invalid, "to keep so much, a recording has to be split into files"};
  if (options.last.count() > 0 && options.split > 0)
    return Error{Code::Invalid, "what is kept in memory is not split into files"};
  Storage storage(options);
  if (options.last.count() == 0)
    if (auto begun = storage.begin_file(0); !begun) return begun.error();
  return storage;
}

/// One file has the name that was given; of several each has a number.
Status Storage::begin_file(std::uint64_t time) {
  if (is_numbered()) number_ = std::max(number_, highest_number(options_.file));
  auto file = File::create(is_numbered() ? numbered(options_.file, number_ + 1) : options_.file);
  if (!file) return file.error();
  ++number_;
  file_ = std::move(*file);
  Status done;
  for (const auto& schema : schemas_)
    if (done) done = file_->add(schema);
  for (const auto& channel : channels_)
    if (done) done = file_->add(channel);
  for (const auto& [name, metadata] : metadata_)
    if (done) done = file_->add(metadata);
  for (const auto& message : lasting_)
    if (done) done = write(message, time);
  return done;
}

Status Storage::write(const Lasting& message, std::uint64_t time) {
  ChunkBuilder chunk;
  const std::span<const std::byte> data[] = {message.data};
  chunk.add({message.channel, message.sequence, time, time}, data);
  return file_->add(packer_->pack(chunk));
}

std::vector<std::string> Storage::files() const {
  std::vector<std::string> files;
  for (const auto& each : done_) files.push_back(each.path);
  return files;
}

Status Storage::end_file() {
  if (!file_) return {};
  auto closed = file_->close();
  done_.push_back({file_->path(), file_->size()});
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

Status Storage::add(SchemaRecord schema) {
  schemas_.push_back(std::move(schema));
  return file_ ? file_->add(schemas_.back()) : Status();
}

Status Storage::add(ChannelRecord channel) {
  channels_.push_back(std::move(channel));
  return file_ ? file_->add(channels_.back()) : Status();
}

Status Storage::add(MetadataRecord metadata) {
  auto& newest = metadata_[metadata.name];
  newest = std::move(metadata);
  return file_ ? file_->add(newest) : Status();
}

Status Storage::add(Lasting message) {
  lasting_.push_back(std::move(message));
  return file_ ? write(lasting_.back(), lasting_.back().log_time) : Status();
}

Status Storage::add(const ChunkBuilder& messages) {
  auto chunk = packer_->pack(messages);
  if (file_) {
    auto added = file_->add(chunk);
    if (!added) lost_ += chunk.messages;
    if (!added || options_.split == 0 || file_->size() < options_.split) return added;
    if (auto ended = end_file(); !ended) return ended;
    if (options_.keep > 0) remove_old();
    return begin_file(chunk.info.end);
  }
  in_memory_ += chunk.bytes.size();
  const auto now = chunk.info.end;
  memory_.push_back(std::move(chunk));
  const auto last = static_cast<std::uint64_t>(options_.last.count());
  while (memory_.size() > 1 &&
         (memory_.front().info.end + last < now || in_memory_ > options_.memory)) {
    in_memory_ -= memory_.front().bytes.size();
    memory_.pop_front();
  }
  return {};
}

Result<std::string> Storage::save() {
  auto done = begin_file(memory_.empty() ? 0 : memory_.front().info.begin);
  const std::string name = file_ ? file_->path() : "";
  for (const auto& chunk : memory_)
    if (done) done = file_->add(chunk);
  if (auto ended = end_file(); done) done = ended;
  if (!done) return done.error();
  return name;
}

Status Storage::close() {
  return end_file();
}

}  // namespace hc::mcap
