// SPDX-License-Identifier: Apache-2.0
#include "recordings.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace {

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
