// SPDX-License-Identifier: Apache-2.0
#include <mcap/storage.h>

#include <unistd.h>

#include <filesystem>

#include <hc/base/format.h>

namespace hc::mcap {

Result<Storage> Storage::make(const StorageOptions& options) {
  if (options.keep > 0 && options.split == 0)
    return Error{Code::Invalid, "to keep so much, a recording has to be split into files"};
  if (options.last.count() > 0 && options.split > 0)
    return Error{Code::Invalid, "what is kept in memory is not split into files"};
  Storage storage(options);
  if (options.last.count() == 0)
    if (auto begun = storage.begin_file(); !begun) return begun.error();
  return storage;
}

/// One file has the name that was given; of several each has a number.
std::string Storage::next_name() const {
  if (options_.split == 0 && options_.last.count() == 0) return options_.file;
  std::filesystem::path path(options_.file);
  const auto stem = path.stem().string(), ending = path.extension().string();
  return path.replace_filename(hc::format("{}_{:04}{}", stem, number_ + 1, ending)).string();
}

Status Storage::begin_file() {
  auto file = File::create(next_name());
  if (!file) return file.error();
  ++number_;
  file_ = std::move(*file);
  Status done;
  for (const auto& schema : schemas_)
    if (done) done = file_->add(schema);
  for (const auto& channel : channels_)
    if (done) done = file_->add(channel);
  for (const auto& metadata : metadata_)
    if (done) done = file_->add(metadata);
  for (const auto& chunk : each_)
    if (done) done = file_->add(chunk);
  return done;
}

Status Storage::end_file() {
  if (!file_) return {};
  auto closed = file_->close();
  lost_ += file_->lost();
  bytes_ += file_->size();
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
  metadata_.push_back(std::move(metadata));
  return file_ ? file_->add(metadata_.back()) : Status();
}

Status Storage::add(PackedChunk chunk, bool in_each) {
  if (in_each) {
    each_.push_back(chunk);
    return file_ ? file_->add(chunk) : Status();
  }
  if (file_) {
    auto added = file_->add(chunk);
    if (!added || options_.split == 0 || file_->size() < options_.split) return added;
    if (auto ended = end_file(); !ended) return ended;
    if (options_.keep > 0) remove_old();
    return begin_file();
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
  const std::string name = next_name();
  auto done = begin_file();
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
