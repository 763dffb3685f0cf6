// SPDX-License-Identifier: Apache-2.0
#include <record/writer.h>

#include <utility>

#include <hc/base/format.h>

namespace hc::record {

Result<std::unique_ptr<Writer>> Writer::open(const Place& place, const WriterOptions& options) {
  const bool is_mcap = place.kind == Place::Kind::Mcap;
  if (!is_mcap && (options.split > 0 || options.keep > 0 || options.last.count() > 0))
    return Error{Code::Invalid, "split, keep and last are for recordings in MCAP: " + place.text() +
                                    " does not end in .mcap"};
  if (place.kind == Place::Kind::Link)
    return Error{Code::Invalid, place.text() +
                                    " is a link; a recording is a file or folder, which "
                                    "is written ./NAME where it begins like a link"};
  for (const auto& [key, value] : place.uri.options)
    return Error{Code::Invalid, place.text() + ": a recording that is made has no option " + key};
  std::set<std::string_view> names;
  for (const auto& name : options.streams)
    if (!names.insert(name).second)
      return Error{Code::Invalid, "streams: \"" + name + "\" is there twice"};
  FormatOptions format_options = options;
  format_options.file = place.path;
  auto format = is_mcap ? open_mcap(format_options)
                : place.kind == Place::Kind::Folder
                    ? open_folder(place.path, options.streams, options.append)
                    : open_message_file(place.path, options.log);
  if (!format) return format.error();
  if (is_mcap)
    for (const auto& name : options.streams)
      if (auto added = (*format)->add_stream(name); !added) return added.error();
  return std::unique_ptr<Writer>(new Writer(std::move(*format), options));
}

Writer::Writer(std::unique_ptr<Format> format, const WriterOptions& options)
    : format_(std::move(format)),
      options_(options),
      clock_(options.clock != nullptr ? *options.clock : system_clock_),
      names_(options.streams) {
  written_.place = format_->place();
}

Writer::~Writer() {
  close();
}

void Writer::say(Level severity, const std::string& line) const {
  if (options_.log) options_.log(severity, line);
}

std::int64_t Writer::now() {
  const auto monotonic = clock_.monotonic().count();
  if (!to_wall_) to_wall_ = clock_.wall() - monotonic;
  return monotonic + *to_wall_;
}

Result<std::size_t> Writer::add_stream(std::string_view name) {
  names_.emplace_back(name);
  if (auto added = note(format_->add_stream(names_.back())); !added) return added.error();
  return names_.size() - 1;
}

Result<std::size_t> Writer::stream_of(std::size_t link, const std::string& name, std::int32_t src) {
  auto& streams = links_[{link, name}];
  const auto known = streams.find(src);
  if (known != streams.end()) return known->second;
  auto added = add_stream(streams.empty() ? name : name + ".src_" + std::to_string(src));
  if (added) streams[src] = *added;
  return added;
}

Status Writer::note(const Status& status) {
  if (status || !written_.status || status.error().code == Code::TooLarge) return status;
  written_.status = status;
  static_cast<void>(format_->close());
  return status;
}

template <typename Write>
Status Writer::record(std::size_t bytes, const Write& write) {
  ++written_.messages;
  written_.bytes += bytes;
  const bool goes_on = written_.status.has_value();
  auto done = goes_on ? note(write()) : written_.status;
  // What the format was given, and has lost, it counts itself.
  if (!done && (!goes_on || done.error().code == Code::TooLarge)) ++written_.lost;
  return done;
}

Status Writer::add(std::size_t stream, const Message& message,
                   std::optional<std::int64_t> log_time) {
  const auto time = log_time.value_or(0) != 0 ? *log_time : now();
  auto added =
      record(message.elements.size(), [&] { return format_->write(stream, message, time); });
  if (!added && added.error().code == Code::TooLarge) {
    if (dropping_.insert(stream).second)
      say(Level::Warning, names_[stream] + " dropped: " + added.error().detail);
    return {};
  }
  if (added && format_->keeps_last() && names_[stream] == options_.when) save_when_set(message);
  return added;
}

Result<bool> Writer::copy(Reader& reader) {
  auto next = reader.next_time();
  if (!next) return next.error();
  if (!*next) return false;
  Reader& file = reader.front();
  if (copies_all() && file.has_more()) {
    auto stored = file.take_stored();
    if (!stored) return stored.error();
    if (!*stored) return false;
    const auto write = [&] { return format_->write(**stored); };
    auto done = (*stored)->is_mtp ? record((*stored)->message.data.size(), write) : note(write());
    return done ? Result<bool>(true) : done.error();
  }
  Message message;
  auto got = reader.take(message);
  if (!got || *got != Got::Message) return got ? Result<bool>(false) : got.error();
  const auto src = file.is_of_outputs() ? 0 : message.header.src;
  auto stream = stream_of(reinterpret_cast<std::size_t>(&file), std::string(reader.stream()), src);
  auto added = stream ? add(*stream, message, reader.log_time()) : stream.error();
  return added ? Result<bool>(true) : added.error();
}

Status Writer::log(const LogLine& line) {
  return written_.status ? note(format_->log(now(), line)) : written_.status;
}

Status Writer::metadata(const std::string& name, const mcap::Words& words) {
  return written_.status ? note(format_->metadata(name, words)) : written_.status;
}

Status Writer::poll() {
  return written_.status ? note(format_->poll()) : written_.status;
}

void Writer::save() {
  if (!format_->keeps_last()) return;
  auto saved = format_->save();
  say(saved ? Level::Info : Level::Error,
      saved ? "saved " + *saved : "not saved: " + saved.error().detail);
}

void Writer::save_when_set(const Message& message) {
  const bool is_set = message.plain() && !message.elements.empty() &&
                      visit_scalar(message.header.info.scalar, [&](auto zero) {
                        return message.view<decltype(zero)>()->numbers().front() != zero;
                      });
  if (is_set && !was_set_) save();
  was_set_ = is_set;
}

const Written& Writer::close() {
  if (std::exchange(is_closed_, true)) return written_;
  auto closed = format_->close();
  if (written_.status) written_.status = closed;
  written_.lost += format_->lost();
  written_.messages -= written_.lost;
  written_.files = format_->files();
  return written_;
}

namespace {

class RecordingSink final : public Sink {
 public:
  explicit RecordingSink(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}

  Status send(const Message& message) override {
    const auto src = message.header.src;
    auto stream =
        writer_->stream_of(static_cast<std::size_t>(src), "src_" + std::to_string(src), src);
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
    options.log(Level::Warning, place.text() + ": the file stays as it is; continuing in " + now);
  return std::unique_ptr<Sink>(new RecordingSink(std::move(*writer)));
}

}  // namespace hc::record
