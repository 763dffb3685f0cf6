// SPDX-License-Identifier: Apache-2.0
#include <record/writer.h>

#include <filesystem>
#include <utility>

#include <hc/base/format.h>
#include <hc/mtp/matrix_view.h>
#include <hc/os/new_file.h>
#include <record/mcap_writer.h>

namespace hc::record {

namespace fs = std::filesystem;

namespace {

bool is_missing(const std::string& path) {
  std::error_code unknown;
  return !fs::exists(path, unknown) && !unknown;
}

}  // namespace

Result<std::unique_ptr<Writer>> Writer::open(const Place& place, const WriterOptions& options) {
  if (place.kind != Place::Kind::Mcap &&
      (options.split > 0 || options.keep > 0 || options.last.count() > 0))
    return Error{Code::Invalid, "split, keep and last are for recordings in MCAP: " + place.text() +
                                    " does not end in .mcap"};
  if (place.kind == Place::Kind::Link)
    return Error{Code::Invalid, place.text() +
                                    " is a link; a recording is a file or folder; write ./NAME "
                                    "for a name that starts like a link"};
  for (const auto& [key, value] : place.uri.options)
    return Error{Code::Invalid, place.text() + ": a new recording has no option " + key};
  std::set<std::string_view> names;
  for (const auto& name : options.streams)
    if (!names.insert(name).second)
      return Error{Code::Invalid, "streams: \"" + name + "\" is given twice"};
  std::unique_ptr<Writer> writer(new Writer(place, options));
  if (auto begun = writer->begin(place); !begun) return begun.error();
  return writer;
}

Writer::Writer(const Place& place, const WriterOptions& options)
    : options_(options),
      clock_(options.clock != nullptr ? *options.clock : system_clock_),
      is_folder_(place.kind == Place::Kind::Folder) {
  written_.place = place.path;
}

Status Writer::begin(const Place& place) {
  bool is_new = false;
  if (place.kind == Place::Kind::Mcap) {
    auto mcap = McapWriter::make(place.path, options_);
    if (!mcap) return mcap.error();
    mcap_ = std::move(*mcap);
    written_.place = mcap_->file();
  } else if (is_folder_) {
    if (!options_.append) written_.place = free_place(place).path;
    std::error_code failed;
    is_new = fs::create_directories(written_.place, failed);
    if (failed) return Error{Code::System, written_.place + ": " + failed.message()};
  } else {
    HC_TRY(begin_file(place.path));
    written_.place = files_.front().path;
  }
  for (const auto& name : options_.streams) {
    auto added = add_stream(name);
    if (added) continue;
    for (const auto& each : files_) remove_unused(each);
    std::error_code ignored;
    if (is_new) fs::remove(written_.place, ignored);
    return added.error();
  }
  return {};
}

Status Writer::begin_file(const std::string& path) {
  File file{path, {}, nullptr, false};
  std::error_code missing;
  Uri uri{"file", path, {}};
  if (options_.append) {
    uri.options = {{"append", "1"}};
    file.is_new = !fs::exists(path, missing);
  } else if (!is_written_in_place(path)) {  // begun here, to know its name
    auto begun = HC_TRY(hc::begin_file(path));
    file.path = std::move(begun.path);
    file.lock = std::move(begun.descriptor);
    file.is_new = begun.is_new;
    uri.rest = "/proc/self/fd/" + std::to_string(file.lock.get());
  }
  LinkOptions options;
  if (!is_folder_) options.log = options_.log;
  auto sink = hc::open_sink(uri, options);
  if (!sink) {
    remove_unused(file);
    return sink.error();
  }
  file.sink = std::move(*sink);
  files_.push_back(std::move(file));
  return {};
}

void Writer::remove_unused(const File& file) {
  std::error_code ignored;
  if (file.is_new && fs::is_empty(file.path, ignored)) fs::remove(file.path, ignored);
}

Writer::~Writer() {
  close();
}

void Writer::say(Level severity, const std::string& line) const {
  if (options_.log) options_.log(severity, line);
}

Time Writer::now() {
  const auto monotonic = clock_.monotonic();
  if (!to_wall_) to_wall_ = clock_.wall().time_since_epoch() - monotonic;
  return Time(monotonic + *to_wall_);
}

Result<std::size_t> Writer::add_stream(std::string_view name) {
  const std::string wanted(name);
  if (mcap_ != nullptr) mcap_->add_stream(wanted);
  if (is_folder_) {
    if (name.empty() || name.find('/') != std::string::npos)
      return Error{Code::Invalid, "streams: \"" + wanted + "\" cannot be a file name"};
    const auto path = stream_file(written_.place, take_name(file_names_, wanted));
    if (auto begun = end_if_failed(begin_file(path)); !begun) return begun.error();
  }
  names_.push_back(wanted);
  return names_.size() - 1;
}

Result<std::size_t> Writer::stream_of(const void* from, const std::string& name, std::int32_t src) {
  auto& streams = links_[{from, name}];
  const auto known = streams.find(src);
  if (known != streams.end()) return known->second;
  auto added = add_stream(streams.empty() ? name : name + ".src_" + std::to_string(src));
  if (added) streams[src] = *added;
  return added;
}

Status Writer::end_if_failed(const Status& status) {
  if (status || !written_.status || status.error().code == Code::TooLarge) return status;
  written_.status = status;
  static_cast<void>(end());
  return status;
}

Error Writer::named(const File& file, const Error& error) const {
  return {error.code, is_folder_ ? file.path + ": " + error.detail : error.detail};
}

Status Writer::write(std::size_t stream, const Message& message, Time log_time) {
  if (mcap_ != nullptr) return mcap_->write(stream, message, log_time);
  auto& file = files_[is_folder_ ? stream : 0];
  auto sent = file.sink->send(message);
  return sent ? sent : named(file, sent.error());
}

template <typename Write>
Status Writer::record(std::size_t bytes, const Write& write) {
  ++written_.messages;
  written_.bytes += bytes;
  const bool goes_on = written_.status.has_value();
  auto done = goes_on ? end_if_failed(write()) : written_.status;
  // The MCAP writer counts messages that it accepted and lost.
  if (!done && (!goes_on || mcap_ == nullptr || done.error().code == Code::TooLarge))
    ++written_.lost;
  return done;
}

Status Writer::add(std::size_t stream, const Message& message, Time log_time) {
  const auto time = log_time != Time() ? log_time : now();
  auto added = record(message.elements.size(), [&] { return write(stream, message, time); });
  if (!added && added.error().code == Code::TooLarge) {
    if (dropping_.insert(stream).second)
      say(Level::Warning, names_[stream] + " dropped: " + added.error().detail);
    return {};
  }
  if (added && options_.last.count() > 0 && names_[stream] == options_.when) save_when_set(message);
  return added;
}

Status Writer::copy_head(Reader& reader) {
  if (mcap_ == nullptr) return {};
  for (const auto& each : HC_TRY(reader.metadata())) HC_TRY(metadata(each.name, each.words));
  reader.for_each_channel(
      [&](const auto& message, const Reader& file) { mcap_->copy_channel(message, &file); });
  return {};
}

Result<bool> Writer::copy(Reader& reader) {
  auto next = reader.next_time();
  if (!next) return next.error();
  if (!*next) return false;
  Reader& file = reader.front();
  auto stored = mcap_ ? file.take_stored() : std::optional<StoredPair>();
  if (!stored) return stored.error();
  if (*stored) {
    const auto& message = (*stored)->message;
    const auto write = [&] { return mcap_->copy(**stored, &file); };
    auto done = is_mtp(message) ? record(message.data.size(), write) : end_if_failed(write());
    return done ? Result<bool>(true) : done.error();
  }
  Message message;
  auto got = reader.take(message);
  if (!got || *got != Got::Message) return got ? Result<bool>(false) : got.error();
  const auto src = file.mixes_sources() ? message.header.src : 0;
  auto stream = stream_of(&file, std::string(reader.stream()), src);
  auto added = stream ? add(*stream, message, reader.log_time()) : stream.error();
  return added ? Result<bool>(true) : added.error();
}

template <typename Write>
Status Writer::to_mcap(const Write& write) {
  return mcap_ != nullptr && written_.status ? end_if_failed(write()) : written_.status;
}

Status Writer::log(const LogLine& line) {
  return to_mcap([&] { return mcap_->log(now(), line); });
}

Status Writer::metadata(const std::string& name, const mcap::StringMap& words) {
  return to_mcap([&] { return mcap_->metadata(name, words); });
}

void Writer::save() {
  if (options_.last.count() == 0) return;
  auto saved = mcap_->save();
  say(saved ? Level::Info : Level::Error,
      saved ? "saved " + *saved : "not saved: " + saved.error().detail);
}

void Writer::save_when_set(const Message& message) {
  const bool is_set = message.plain() && !message.elements.empty() &&
                      visit_scalar(message.header.info.scalar, [&](auto zero) {
                        return view<decltype(zero)>(message)->numbers().front() != zero;
                      });
  if (is_set && !was_set_) save();
  was_set_ = is_set;
}

Status Writer::end() {
  if (mcap_ != nullptr) return mcap_->close();
  Status status;
  for (auto& file : files_) {
    if (file.sink == nullptr) continue;
    auto closed = file.sink->close();
    if (!closed && status) status = named(file, closed.error());
    written_.lost += file.sink->traffic().dropped_disconnect;
    file.sink.reset();
    file.lock = {};
  }
  return status;
}

Status Writer::check_places() const {
  std::vector<std::string> paths;
  for (const auto& file : files_) paths.push_back(file.path);
  if (mcap_ != nullptr && options_.split == 0 && options_.last.count() == 0)
    paths.push_back(written_.place);
  for (const auto& path : paths)
    if (is_missing(path))
      return Error{Code::NotFound, path + " was removed or renamed while it was written"};
  return {};
}

const Written& Writer::close() {
  if (std::exchange(is_closed_, true)) return written_;
  const auto found = check_places();
  const auto ended = end();
  for (const auto& status : {ended, found})
    if (written_.status) written_.status = status;
  for (const auto& file : files_) written_.files.push_back(file.path);
  if (mcap_ != nullptr) {
    written_.files = mcap_->files();
    written_.lost += mcap_->lost();
  }
  std::erase_if(written_.files, is_missing);
  written_.messages -= written_.lost;
  if (mcap_ != nullptr) {
    written_.discarded = written_.messages - mcap_->stored();
    written_.messages = mcap_->stored();
  }
  return written_;
}

namespace {

class RecordingSink final : public Sink {
 public:
  explicit RecordingSink(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}

  Status send(const Message& message) override {
    const auto src = message.header.src;
    auto stream = writer_->stream_of(this, "src_" + std::to_string(src), src);
    return stream ? writer_->add(*stream, message) : Status(stream.error());
  }
  Status close() override { return writer_->close().status; }
  [[nodiscard]] Traffic traffic() const override {
    Traffic traffic;
    traffic.messages = writer_->written().messages;
    traffic.bytes = writer_->written().bytes;
    return traffic;
  }

 private:
  const std::unique_ptr<Writer> writer_;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_sink(const Place& place, const LinkOptions& options) {
  if (place.kind == Place::Kind::Link || place.kind == Place::Kind::File)
    return hc::open_sink(place.uri, options);
  WriterOptions writer_options;
  writer_options.log = options.log;
  auto writer = Writer::open(place, writer_options);
  if (!writer) return writer.error();
  if (const auto& now = (*writer)->written().place; now != place.path && options.log)
    options.log(Level::Notice, place.text() + ": the file stays as it is; continuing in " + now);
  return std::unique_ptr<Sink>(new RecordingSink(std::move(*writer)));
}

}  // namespace hc::record
