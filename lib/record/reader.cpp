// SPDX-License-Identifier: Apache-2.0
#include <record/reader.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include <hc/base/suggestion.h>

namespace hc::record {
namespace {

namespace fs = std::filesystem;

class MergedReader final : public Reader {
 public:
  struct File {
    std::unique_ptr<Reader> reader;
    std::string place;
    bool has_ended = false;
  };

  explicit MergedReader(std::vector<File> files) : files_(std::move(files)) {}

  Result<Got> take(Message& message) override {
    message = {};
    auto next = HC_TRY(next_time());
    if (!next) return Got::End;
    auto got = last_->reader->take(message);
    if (!got) return failed(got.error());
    if (last_->reader->log_time() != Time()) time_ = last_->reader->log_time();
    return got;
  }

  Result<std::optional<Time>> next_time() override {
    std::optional<Time> least, least_known;
    File* first = nullptr;
    for (auto& file : files_) {
      if (file.has_ended) continue;
      last_ = &file;
      auto next = file.reader->next_time();
      if (!next && next.error().code != Code::Truncated) return failed(next.error());
      if (!next) add_truncated(next.error());
      file.has_ended = !next || !*next;
      if (file.has_ended) continue;
      if (!least || **next < *least) {
        least = *next;
        first = &file;
      }
      if (**next != Time() && (!least_known || **next < *least_known)) least_known = *next;
    }
    if (first != nullptr) last_ = first;
    if (!least && truncated_) return *std::exchange(truncated_, std::nullopt);
    if (time_ == Time()) time_ = least_known.value_or(Time());
    return least;
  }

  [[nodiscard]] Time log_time() const override { return time_; }
  [[nodiscard]] std::string_view stream() const override { return last_->reader->stream(); }
  [[nodiscard]] int descriptor() const override { return last_->reader->descriptor(); }
  Status resume() override {
    Reader* reader = std::exchange(failed_, nullptr);
    return reader != nullptr ? reader->resume()
                             : Status();  // none after Truncated: the other files continue
  }
  Reader& front() override { return *last_->reader; }
  void start_at(Time log_time) override {
    for (auto& file : files_) file.reader->start_at(log_time);
  }
  [[nodiscard]] Traffic traffic() const override {
    Traffic all;
    for (const auto& file : files_) all += file.reader->traffic();
    return all;
  }
  Result<std::vector<StreamInfo>> streams(StreamDetail detail) override {
    std::vector<StreamInfo> all;
    for (auto& file : files_) {
      auto streams = file.reader->streams(detail);
      if (!streams) return streams.error();
      std::ranges::move(*streams, std::back_inserter(all));
    }
    return all;
  }
  Result<std::vector<mcap::MetadataRecord>> metadata() override {
    std::vector<mcap::MetadataRecord> all;
    for (auto& file : files_) {
      auto metadata = file.reader->metadata();
      if (!metadata) return metadata.error();
      std::ranges::move(*metadata, std::back_inserter(all));
    }
    return all;
  }
  [[nodiscard]] std::string profile() const override {
    const auto first = files_.front().reader->profile();
    return std::ranges::all_of(files_,
                               [&](const auto& file) { return file.reader->profile() == first; })
               ? first
               : "";
  }
  void for_each_channel(const TakeChannel& take) const override {
    for (const auto& file : files_) file.reader->for_each_channel(take);
  }

 private:
  [[nodiscard]] Error named(const Error& error) const {
    return {error.code, last_->place + ": " + error.detail};
  }
  Error failed(const Error& error) {
    failed_ = last_->reader.get();
    return named(error);
  }
  /// Adds a truncated file to the error returned after the last message of all files.
  void add_truncated(const Error& error) {
    if (truncated_)
      truncated_->detail += "; " + named(error).detail;
    else
      truncated_ = named(error);
  }

  std::vector<File> files_;
  File* last_ = files_.data();      // of the last or the next message
  Reader* failed_ = nullptr;        // to be resumed
  std::optional<Error> truncated_;  // of all truncated files
  Time time_;
};

/// The recordings in a folder, or that of one stream.
Result<std::vector<Place>> files_of(const Place& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  fs::directory_iterator each(folder.path, failed);
  for (; !failed && each != fs::directory_iterator(); each.increment(failed))
    if (each->path().extension() == ".mtp") names.push_back(each->path().stem().string());
  if (failed) return Error{Code::NotFound, folder.path + ": " + failed.message()};
  if (names.empty())
    return Error{Code::NotFound,
                 folder.path + ": no MODULE.PORT.mtp in it, as hc run --record writes them"};
  std::ranges::sort(names);
  if (!folder.stream.empty()) {
    if (std::ranges::find(names, folder.stream) == names.end())
      return Error{Code::NotFound, folder.path + ": no stream \"" + folder.stream + "\"" +
                                       suggestion(folder.stream, names)};
    names = {folder.stream};
  }
  std::vector<Place> places;
  for (const auto& name : names) {
    const auto path = stream_file(folder.path, name);
    places.push_back({Place::Kind::File, path, name, {"file", path, {}}});
  }
  return places;
}

}  // namespace

Result<std::unique_ptr<Reader>> Reader::open(const std::vector<Place>& places,
                                             const LinkOptions& options, Topics topics) {
  std::vector<MergedReader::File> opened;
  for (const auto& place : places) {
    auto files = place.kind == Place::Kind::Folder ? files_of(place) : std::vector{place};
    if (!files) return files.error();
    for (const auto& file : *files) {
      auto reader = file.kind == Place::Kind::Mcap ? read_mcap(file, options, topics)
                                                   : read_messages(file, options);
      if (!reader) return reader.error();
      opened.push_back({std::move(*reader), file.text()});
    }
  }
  if (opened.size() == 1) return std::move(opened.front().reader);
  return std::unique_ptr<Reader>(new MergedReader(std::move(opened)));
}

Result<std::unique_ptr<Source>> open_source(std::string_view word, const LinkOptions& options) {
  const Place place = HC_TRY(place_of(word));
  if (place.kind == Place::Kind::Link || place.kind == Place::Kind::File)
    return hc::open_source(place.uri, options);
  auto reader = Reader::open({place}, options);
  if (!reader) return reader.error();
  return std::unique_ptr<Source>(std::move(*reader));
}

}  // namespace hc::record
