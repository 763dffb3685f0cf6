// SPDX-License-Identifier: Apache-2.0
#include <record/place.h>

#include <filesystem>

#include <hc/base/place_word.h>
#include <hc/os/new_file.h>

namespace hc::record {
namespace {

namespace fs = std::filesystem;

bool has_no_recording(const std::string& folder) {
  std::error_code missing;
  fs::directory_iterator each(folder, missing);
  for (; !missing && each != fs::directory_iterator(); each.increment(missing))
    if (each->path().extension() == ".mtp") return false;
  return true;
}

bool has_no_contents(const std::string& file) {
  std::error_code missing;
  return fs::file_size(file, missing) == 0 || missing;
}

}  // namespace

std::string Place::text() const {
  if (kind == Kind::Link) return uri.text();
  return stream.empty() || kind == Kind::File ? path : path + "?stream=" + stream;
}

std::string Place::name() const {
  if (!stream.empty()) return stream;
  if (kind == Kind::Link) return uri.scheme == "-" ? "messages" : uri.rest;
  const auto file = fs::path(path).filename();
  return file.extension() == ".mtp" || is_mcap_path(path) ? file.stem() : file;
}

Result<Place> place_of(std::string_view word) {
  Place place;
  std::error_code missing;
  place.uri = HC_TRY(parse_place_word(word));
  if (place.uri.scheme != "file") {
    place.kind = Place::Kind::Link;
    return place;
  }
  place.path = place.uri.rest;
  place.stream = place.uri.option("stream", "");
  if (is_mcap_path(place.path))
    place.kind = Place::Kind::Mcap;
  else if (place.path.ends_with('/') || fs::is_directory(place.path, missing))
    place.kind = Place::Kind::Folder;
  return place;
}

Result<Place> place_of_streams(std::string_view word) {
  Place place = HC_TRY(place_of(word));
  if (place.kind == Place::Kind::Link)
    return Error{Code::Invalid, place.text() +
                                    " is a link; a recording is a folder or FILE.mcap; write "
                                    "./NAME for a name that starts like a link"};
  if (place.kind != Place::Kind::Mcap) place.kind = Place::Kind::Folder;
  return place;
}

Place free_place(Place place, bool is_numbered) {
  if (place.kind == Place::Kind::Folder)
    place.path = free_name(place.path, "", has_no_recording);
  else if (!is_numbered)
    place.path = free_name(place.path, fs::path(place.path).extension().string(), has_no_contents);
  return place;
}

std::string stream_file(const std::string& folder, const std::string& stream) {
  return (fs::path(folder) / (stream + ".mtp")).string();
}

}  // namespace hc::record
