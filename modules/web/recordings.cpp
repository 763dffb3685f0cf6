// SPDX-License-Identifier: Apache-2.0
#include "recordings.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include <hc/base/natural_order.h>
#include <record/reader.h>

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kEnding = ".mcap";

struct Recorded {
  std::string name;
  std::uintmax_t bytes = 0;
  std::vector<std::string> streams;  // MODULE.PORT
  std::string problem;               // why it cannot be read; empty: it can
};

// These wait for the disk, so they must not run on the server's thread, which also handles stops.

/// The recordings in a folder, by name.
std::vector<Recorded> list_recordings(const std::string& folder) {
  std::vector<Recorded> all;
  std::error_code failed;
  fs::directory_iterator each(folder, failed);
  for (; !failed && each != fs::directory_iterator(); each.increment(failed)) {
    Recorded recorded{each->path().stem().string(), 0, {}, ""};
    if (each->path().extension() != kEnding || !is_recording_name(recorded.name)) continue;
    auto reader = hc::mcap::Reader::open(each->path());
    if (reader) {
      recorded.bytes = reader->size();
      for (const auto& stream : hc::record::streams_of(reader->summary()))
        recorded.streams.push_back(stream.name);
    } else {
      std::error_code no_file;
      recorded.bytes = fs::file_size(each->path(), no_file);
      if (no_file) continue;
      recorded.problem = reader.error().detail;
    }
    all.push_back(std::move(recorded));
  }
  std::ranges::sort(all, hc::natural_less, &Recorded::name);
  return all;
}

/// The recording in a file NAME.mcap, in its current length; 404 if there is none.
web::Reply recorded_file(const std::string& folder, const std::string& file) {
  web::Reply reply;
  struct stat about {};
  // O_NONBLOCK, so as not to wait for the writer of a FIFO.
  if (file.ends_with(kEnding) && is_recording_name(file.substr(0, file.size() - kEnding.size())))
    reply.file =
        hc::Descriptor(::open((folder + "/" + file).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!reply.file || ::fstat(reply.file.get(), &about) != 0 || !S_ISREG(about.st_mode))
    return web::refusal(404, "no such recording");
  reply.size = static_cast<std::uint64_t>(about.st_size);
  reply.type = "application/octet-stream";
  reply.fields = {{"Content-Disposition", "attachment; filename=\"" + file + "\""}};
  return reply;
}

/// Errors: Invalid (there is none), System.
hc::Status delete_recording(const std::string& folder, const std::string& name) {
  const fs::path path = folder + "/" + name + std::string(kEnding);
  std::error_code failed;
  if (!is_recording_name(name) || fs::symlink_status(path, failed).type() != fs::file_type::regular)
    return hc::Error{hc::Code::Invalid, "no recording " + name};
  if (fs::remove(path, failed); failed)
    return hc::Error{hc::Code::System, path.string() + ": " + failed.message()};
  return {};
}

web::Reply list_of(const std::string& folder) {
  auto list = nlohmann::json::array();
  for (const auto& [name, bytes, streams, problem] : list_recordings(folder)) {
    list.push_back({{"name", name}, {"bytes", bytes}, {"streams", streams}});
    if (!problem.empty()) list.back()["problem"] = problem;
  }
  web::Reply reply;
  reply.type = "application/json";
  // Names of recorded streams may be invalid UTF-8.
  reply.body = std::make_shared<const std::string>(
      list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  reply.fields = {{"Cache-Control", "no-store"}};
  return reply;
}

}  // namespace

Recordings::Recordings(hc::RunningGraph graph, Recorder::Options options, web::Server& server)
    : graph_(std::move(graph)), options_(std::move(options)), server_(server) {}

web::Reply Recordings::reply(const std::string& path) const {
  web::Reply reply;
  reply.aside = [folder = options_.folder, path] {
    if (path == "/recordings") return list_of(folder);
    return recorded_file(folder, path.substr(std::string_view("/recordings/").size()));
  };
  return reply;
}

void Recordings::take(const std::vector<std::string>& command, const Answer& answer) {
  if (!job_.expired())
    return answer("a recording is being started or ended; try again in a moment");
  if (command.size() == 3 && command[1] == "delete") return remove(command[2], answer);
  if (command.size() == 2 && command[1] == "end") return end(answer);
  begin(command, answer);
}

void Recordings::begin(const std::vector<std::string>& command, const Answer& answer) {
  if (recorder_) return answer("already recording: " + recorder_->name());
  if (command.size() < 3)
    return answer("record is followed by a name and outputs, MODULE.PORT, by end, or delete NAME");
  run_job(
      [this, command, answer] {
        auto begun =
            Recorder::begin(graph_, options_, command[1], {command.begin() + 2, command.end()});
        const std::string problem = begun ? "" : begun.error().detail;
        std::shared_ptr<Recorder> recorder = begun ? std::move(*begun) : nullptr;
        return [this, answer, problem, recorder] {
          recorder_ = recorder;
          answer(problem);
        };
      },
      answer);
}

void Recordings::end(const Answer& answer) {
  if (!recorder_) return answer("nothing is being recorded");
  run_job(
      [this, recorder = recorder_, answer] {
        recorder->end();
        return [this, answer] {
          recorder_.reset();
          answer("");
        };
      },
      answer);
}

void Recordings::remove(const std::string& name, const Answer& answer) {
  if (recorder_ && recorder_->name() == name) return answer(name + " is being recorded");
  run_job(
      [this, name, answer] {
        const auto deleted = delete_recording(options_.folder, name);
        return [answer, problem = deleted ? "" : deleted.error().detail] { answer(problem); };
      },
      answer);
}

void Recordings::run_job(web::Work work, const Answer& answer) {
  const auto job = std::make_shared<web::Work>(std::move(work));
  job_ = job;
  const auto begun = server_.aside([job] { return [job, then = (*job)()] { then(); }; });
  if (!begun) answer(begun.error().detail);
}

void Recordings::tick() {
  if (recorder_ && !recorder_->goes_on() && job_.expired()) end([](const auto&) {});
}

nlohmann::json Recordings::current() const {
  if (!recorder_) return nullptr;
  return {{"name", recorder_->name()},
          {"bytes", recorder_->bytes()},
          {"seconds", static_cast<int>(recorder_->seconds())},
          {"streams", recorder_->ports()}};
}
