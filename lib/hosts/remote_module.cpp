// SPDX-License-Identifier: Apache-2.0
#include <hosts/remote_module.h>

#include <fcntl.h>

#include <hc/base/uri.h>

namespace hc::hosts {
namespace {

/// Who connects to a name at which somebody listens.
std::string peer_of(const std::string& listening, const std::string& options) {
  const auto name = listening.substr(0, listening.find('?'));
  return "unix" + name.substr(name.find(':')) + options;
}

}  // namespace

Result<std::shared_ptr<RemoteModule>> RemoteModule::make(std::int64_t number,
                                                         const std::string& manage,
                                                         const std::string& control) {
  std::shared_ptr<RemoteModule> module(new RemoteModule(number));
  auto has_ended = internal::Event::make();
  if (!has_ended) return has_ended.error();
  module->has_ended_ = std::move(*has_ended);
  int ends[2];
  auto made =
      internal::system_call("pipe2", "", [&] { return ::pipe2(ends, O_CLOEXEC | O_NONBLOCK); });
  if (!made) return made.error();
  module->output_ = internal::Descriptor(ends[0]);
  module->says_ = internal::Descriptor(ends[1]);
  if (!control.empty()) module->control_ = peer_of(control, "");
  // Reports never wait for who reads them.
  auto uri = parse_uri(peer_of(manage, "?keep=1024"));
  auto reports = uri ? open_sink(*uri) : uri.error();
  if (!reports) return reports.error();
  module->reports_ = std::move(*reports);
  return module;
}

void RemoteModule::said(std::string_view bytes) const {
  // Where the runner does not come to read them they are dropped: it must not keep us from others.
  [[maybe_unused]] auto written = ::write(says_.get(), bytes.data(), bytes.size());
}

void RemoteModule::reported(const Message& message) {
  if (reports_ && !reports_->send(message)) reports_.reset();
}

void RemoteModule::listens(internal::Loop& loop,
                           std::function<void(const Message& message)> command) {
  if (control_.empty()) return;
  auto commands = internal::Intake::make(loop, control_, std::move(command));
  if (commands) commands_ = std::move(*commands);
}

void RemoteModule::ended(int status) {
  if (status_ >= 0) return;
  commands_.reset();
  if (reports_) static_cast<void>(reports_->close());
  reports_.reset();
  says_.reset();
  status_ = status;
  has_ended_.raise();
}

}  // namespace hc::hosts
