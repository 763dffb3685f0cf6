// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records messages to MCAP or a folder. `hc run --record` adds it to a graph, with an input for
// each recorded output.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <client/graph_client.h>
#include <hc/base/clock.h>
#include <hc/module/module.h>
#include <hc/os/loop.h>
#include <record/writer.h>

#include "graph_metadata.h"

/// An input and the name of its stream.
struct StreamName {
  std::string input, name;
};

/// Those of the command line, "--streams INPUT=NAME INPUT=NAME …"; by default one.
std::vector<StreamName> stream_names(int argc, char** argv);

/// The module's clock, which is the messages' time with --clock.
class ModuleClock final : public hc::Clock {
 public:
  explicit ModuleClock(const hc::Module& module) : module_(module) {}
  [[nodiscard]] hc::MonotonicTime monotonic() const override { return module_.monotonic(); }
  [[nodiscard]] hc::Time wall() const override { return module_.now(); }

 private:
  const hc::Module& module_;
};

struct RecorderParameters {
  hc::Module& module;

  hc::Parameter<std::string> file = module.parameter(
      "file", "", "", "output file in MCAP format; default recording.mcap unless `folder` is given",
      {.fixed = true});
  hc::Parameter<std::string> folder = module.parameter(
      "folder", "", "", "record into this folder instead of `file`, one STREAM.mtp for each stream",
      {.fixed = true});
  hc::Parameter<bool> append = module.parameter(
      "append", false, "", "append to existing files in `folder`, as when a graph resumes",
      {.fixed = true});
  hc::Parameter<std::string> streams = module.parameter(
      "streams", "", "", "inputs and names of their streams, INPUT=NAME …", {.fixed = true});
  hc::Parameter<std::string> split = module.parameter(
      "split", "0", "", "size of a file in bytes at which a new one begins (1G); 0: never",
      {.fixed = true});
  hc::Parameter<std::string> keep = module.parameter(
      "keep", "0", "", "maximum size of all files, the oldest are removed (10G); 0: unlimited",
      {.fixed = true});
  hc::Parameter<double> last = module.parameter(
      "last", 0.0, "s",
      "keep the last seconds in memory, and write them on SIGUSR1 or by `when`; 0: off",
      {.fixed = true});
  hc::Parameter<std::string> when = module.parameter(
      "when", "", "", "MODULE.PORT: saves when its first number becomes other than 0",
      {.fixed = true});
  hc::Parameter<std::string> frames =
      module.parameter("frames", "", "", "frames of the graph, as text", {.fixed = true});

  /// Those that are given by parameters. Invalid ones end the module.
  [[nodiscard]] hc::record::WriterOptions options() const;
  /// Where to record. Parameters that exclude each other end the module.
  [[nodiscard]] hc::record::Place place(const hc::record::WriterOptions& options) const;
};

class StreamRecorder {
 public:
  /// @param module  must outlive it.
  StreamRecorder(hc::Module& module, const std::vector<StreamName>& streams);

  /// @param status  of run(). @returns  that of the program.
  [[nodiscard]] int finish(int status) const;

 private:
  void start();
  void save_when_signalled();
  void look();
  void end();
  void fail_once(const hc::Status& status);

  hc::Module& module_;
  const int signals_;                 // reads SIGUSR1
  std::vector<std::string> streams_;  // an input each
  const RecorderParameters parameters_{module_};

  const ModuleClock clock_{module_};
  std::unique_ptr<hc::record::Writer> recording_;  // null: before the start
  const std::unique_ptr<hc::Loop> loop_;
  std::optional<GraphMetadata> metadata_;
  std::optional<hc::GraphClient> graph_;  // none: not in a graph, or not recorded
  bool has_failed_ = false, is_removed_ = false;
};
