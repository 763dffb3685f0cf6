// SPDX-License-Identifier: Apache-2.0
#pragma once
// The recordings of a page: lists, serves, makes and deletes them (spec/page.md, section 6). Waits
// for the disk on other threads. For the server's thread.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hc/base/log.h>
#include <web/server.h>
#include "recorder.h"

namespace web = hc::web;

class Recordings {
 public:
  /// Called on the server's thread.
  /// @param problem  empty: the command is executed.
  using Answer = std::function<void(const std::string& problem)>;

  Recordings(hc::RunningGraph graph, Recorder::Options options, web::Server& server);

  /// The reply to a GET of /recordings, their list, or /recordings/NAME.mcap.
  [[nodiscard]] web::Reply reply(const std::string& path) const;

  /// Executes `record NAME MODULE.PORT …`, `record end` or `record delete NAME`: one at a time.
  void take(const std::vector<std::string>& command, const Answer& answer);

  /// Ends a recording that cannot continue. To be called periodically.
  void tick();

  /// The running recording: its `name`, `bytes`, `seconds` and `streams`; null: none.
  [[nodiscard]] nlohmann::json current() const;

 private:
  void begin(const std::vector<std::string>& command, const Answer& answer);
  void end(const Answer& answer);
  void remove(const std::string& name, const Answer& answer);
  /// As Server::aside(), but a job at a time.
  void run_job(web::Work work, const Answer& answer);

  const hc::RunningGraph graph_;
  const Recorder::Options options_;
  web::Server& server_;
  std::shared_ptr<Recorder> recorder_;
  std::weak_ptr<web::Work> job_;  // begins, ends or deletes a recording
};
