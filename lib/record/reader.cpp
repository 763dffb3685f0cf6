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

/// Several recordings as one.
class MergedReader final : public Reader {
 public:
  MergedReader(std::vector<std::unique_ptr<Reader>> readers, std::vector<std::string> places)
      : readers_(std::move(readers)), last_(readers_.front().get()) {
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      open_.push_back(readers_[i].get());
      places_[open_[i]] = std::move(places[i]);
    }
  }

  Result<Got> take(Message& message) override {
    message = {};
    while (true) {
      auto next = next_time();
      if (!next) return next.error();
      if (!*next) return Got::End;
      auto got = last_->take(message);
      if (got && *got == Got::End) continue;  // of MCAP, it had other messages
      if (!got) return named(*last_, got.error());
      if (last_->log_time() != 0) time_ = last_->log_time();
      return got;
    }
  }

  Result<std::optional<std::int64_t>> next_time() override {
    std::optional<std::int64_t> least, least_known;
    for (std::size_t i = 0; i < open_.size();) {
      auto next = open_[i]->next_time();
      if (!next && next.error().code != Code::Truncated) {
        last_ = open_[i];
        return named(*last_, next.error());
      }
      if (!next) truncated_ = named(*open_[i], next.error());
      if (!next || !*next) {
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
        continue;
      }
      if (!least || **next < *least) {
        least = *next;
        last_ = open_[i];
      }
      if (**next != 0 && (!least_known || **next < *least_known)) least_known = *next;
      ++i;
    }
    if (!least && truncated_) return *truncated_;
    if (time_ == 0) time_ = least_known.value_or(0);
    return least;
  }

  [[nodiscard]] std::int64_t log_time() const override { return time_; }
  [[nodiscard]] std::string_view stream() const override { return last_->stream(); }
  [[nodiscard]] int descriptor() const override { return last_->descriptor(); }
  Status resume() override { return last_->resume(); }
  Reader& front() override { return last_->front(); }
  void start_at(std::int64_t log_time) override {
    for (auto& reader : readers_) reader->start_at(log_time);
  }
  [[nodiscard]] Traffic traffic() const override {
    Traffic all;
    for (const auto& reader : readers_) all += reader->traffic();
    return all;
  }
  Result<std::vector<StreamInfo>> streams(bool counted) override {
    std::vector<StreamInfo> all;
    for (auto& reader : readers_) {
      auto streams = reader->streams(counted);
      if (!streams) return streams.error();
      std::ranges::move(*streams, std::back_inserter(all));
    }
    return all;
  }
  Result<std::map<std::string, mcap::Words>> metadata() override {
    std::map<std::string, mcap::Words> all;
    for (auto& reader : readers_) {
      auto metadata = reader->metadata();
      if (!metadata) return metadata.error();
      all.merge(*metadata);
    }
    return all;
  }

 private:
  [[nodiscard]] Error named(const Reader& reader, const Error& error) const {
    return {error.code, places_.at(&reader) + ": " + error.detail};
  }

  const std::vector<std::unique_ptr<Reader>> readers_;
  std::map<const Reader*, std::string> places_;
  std::vector<Reader*> open_;       // that have not ended
  Reader* last_;                    // from which the last message was, or is the next
  std::optional<Error> truncated_;  // of one that has no end
  std::int64_t time_ = 0;
};

/// The files of a folder that are recordings, or the one of a stream.
Result<std::vector<Place>> files_of(const Place& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  fs::directory_iterator each(folder.path, failed);
  for (; !failed && each != fs::directory_iterator(); each.increment(failed))
    if (each->path().extension() == ".mtp") names.push_back(each->path().stem().string());
  if (failed) return Error{Code::NotFound, folder.path + ": " + failed.message()};
  if (names.empty())
    return Error{Code::NotFound,
                 folder.path + ": no MODULE.PORT.mtp in it; hc run --record writes them"};
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
                                             const LinkOptions& options, bool all) {
  std::vector<std::unique_ptr<Reader>> readers;
  std::vector<std::string> names;
  auto add = [&](const Place& place) -> Status {
    auto reader = place.kind == Place::Kind::Mcap ? read_mcap(place, options, all)
                                                  : read_messages(place, options);
    if (!reader) return reader.error();
    readers.push_back(std::move(*reader));
    names.push_back(place.text());
    return {};
  };
  for (const auto& place : places) {
    auto files = place.kind == Place::Kind::Folder ? files_of(place) : std::vector{place};
    if (!files) return files.error();
    for (const auto& file : *files)
      if (auto added = add(file); !added) return added.error();
  }
  if (readers.size() == 1) return std::move(readers.front());
  return std::unique_ptr<Reader>(new MergedReader(std::move(readers), std::move(names)));
}

Result<std::unique_ptr<Source>> open_source(std::string_view word, const LinkOptions& options) {
  const auto place = place_of(word);
  if (place.kind == Place::Kind::Link || place.kind == Place::Kind::File)
    return hc::open_source(place.uri, options);
  auto reader = Reader::open({place}, options);
  if (!reader) return reader.error();
  return std::unique_ptr<Source>(std::move(*reader));
}

}  // namespace hc::record
