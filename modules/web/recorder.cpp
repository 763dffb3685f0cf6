// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include <client/graph_client.h>
#include <hc/compress/compress.h>
#include <hc/contract/description.h>

#include "encoder.h"

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxName = 40, kMaxPorts = 256;

/// Records the descriptions of the modules of ports, with the columns of tables.
void record_descriptions(hc::record::Writer& writer, const hc::RunningGraph& graph,
                         const std::vector<std::string>& ports) {
  std::set<std::string> modules;
  for (const auto& port : ports) modules.insert(port.substr(0, port.find('.')));
  for (const auto& module : modules) {
    const auto answer = hc::ask(graph, {"describe " + module});
    if (!answer) return;  // the graph has ended, or hangs
    if (answer->is_ok && !answer->rows.empty())
      static_cast<void>(writer.metadata(hc::record::kDescriptionPrefix + module,
                                        {{hc::record::kDescriptionKey, answer->rows.front()}}));
  }
}

}  // namespace

bool is_recording_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxName &&
         std::ranges::all_of(name, hc::is_of_graph_name);
}

hc::Result<std::unique_ptr<Recorder>> Recorder::begin(const hc::RunningGraph& graph,
                                                      const Options& options,
                                                      const std::string& name,
                                                      const std::vector<std::string>& ports) {
  using hc::Code;
  if (!is_recording_name(name))
    return hc::Error{Code::Invalid,
                     "the name of a recording must have 1 to 40 letters, digits, - and _"};
  if (ports.empty() || ports.size() > kMaxPorts ||
      std::set<std::string>(ports.begin(), ports.end()).size() < ports.size())
    return hc::Error{Code::Invalid, "give 1 to 256 different outputs MODULE.PORT"};
  for (const auto& port : ports)
    if (!hc::is_port_name(port))
      return hc::Error{Code::Invalid, "\"" + port + "\" is not MODULE.PORT"};
  const hc::record::Place place =
      HC_TRY(hc::record::place_of(options.folder + "/" + name + ".mcap"));
  std::error_code failed;
  if (fs::symlink_status(place.path, failed).type() != fs::file_type::not_found)
    return hc::Error{Code::Invalid, "recording " + name + " exists already"};
  fs::create_directories(options.folder, failed);
  if (failed) return hc::Error{Code::System, options.folder + ": " + failed.message()};
  hc::record::WriterOptions writer_options;
  writer_options.streams = ports;
  writer_options.frames = options.frames;
  writer_options.log = options.log;
  auto writer = hc::record::Writer::open(place, writer_options);
  if (!writer) return writer.error();
  record_descriptions(**writer, graph, ports);
  std::unique_ptr<Recorder> recorder(new Recorder(std::move(*writer), options.log, name, ports));
  for (std::size_t i = 0; i < ports.size(); ++i)
    recorder->taps_.push_back(std::make_unique<hc::Tap>(
        graph, ports[i],
        hc::Tap::Callbacks{
            .message = [self = recorder.get(), i](const auto& message) { self->write(i, message); },
            .end =
                [&log = recorder->log_, port = ports[i]](const std::string& why, bool is_error) {
                  if (is_error) log(hc::Level::Error, "recording of " + port + " ended: " + why);
                }}));
  return recorder;
}

Recorder::Recorder(std::unique_ptr<hc::record::Writer> writer, hc::LogSink log, std::string name,
                   std::vector<std::string> ports)
    : log_(std::move(log)),
      name_(std::move(name)),
      ports_(std::move(ports)),
      writer_(std::move(writer)) {}

void Recorder::end() {
  taps_.clear();
  if (const auto& written = writer_->close(); !written.status) fail(written.status.error());
}

void Recorder::write(std::size_t stream, const hc::Message& message) {
  if (has_failed_) return;
  // Raw u8 images would fill the disk: record them as JPEG, all else unchanged.
  auto kept = hc::expand(message);
  if (kept && is_picture(kept->header) && kept->header.info.components != 4)
    kept = hc::compress(*kept, hc::Encoding::Jpeg);
  const std::lock_guard lock(mutex_);
  if (auto added = writer_->add(stream, kept ? *kept : message); !added) return fail(added.error());
  bytes_ = writer_->written().bytes;
}

void Recorder::fail(const hc::Error& error) {
  if (!has_failed_.exchange(true))
    log_(hc::Level::Error, "recording of " + name_ + " ended: " + error.detail +
                               "; the messages written before are kept");
}

double Recorder::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}
