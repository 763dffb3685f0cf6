// SPDX-License-Identifier: Apache-2.0
#include <hc/module/link_opener.h>

#include <utility>

#include <hc/module/ending.h>
#include <hc/module/management.h>

namespace hc {
namespace {

constexpr std::chrono::milliseconds kLineDelay{200};

}  // namespace

bool Module::LinkOpener::is_in_graph() const {
  return module_.management_->commands() != nullptr;
}

std::string Module::LinkOpener::name_of(const std::string& uri, const std::string& port) const {
  const bool is_of_graph = uri.starts_with("shm:") || uri.find(":@") != std::string::npos;
  return is_in_graph() && is_of_graph ? port : uri;
}

LinkOptions Module::LinkOpener::options_for(const Uri& uri, const std::string& port) {
  LinkOptions options = options_;
  options.log = [this, uri = uri.text(), port](Level level, std::string_view line) {
    if (!line.starts_with(uri)) return module_.log(line, level);
    const std::string rest(line.substr(uri.size()));
    // An error of a file, which is read on; `hc run` repeats the line at its end.
    if (uri.starts_with("file:")) return module_.log(port + rest, level);
    const std::string name = name_of(uri, port);
    if (name == uri) return module_.log(line, level);
    lines_.push_back({uri, name + rest, level, module_.clock_.monotonic() + kLineDelay});
  };
  return options;
}

std::unique_ptr<Source> Module::LinkOpener::open(const Uri& uri, const std::string& port) {
  auto source = open_source(uri, options_for(uri, port));
  if (!source) internal::fail(name_of(uri.text(), port), source.error());
  return std::move(*source);
}

void Module::LinkOpener::log_lines(MonotonicTime now) {
  for (; !lines_.empty() && lines_.front().due <= now; lines_.pop_front())
    module_.log(lines_.front().text, lines_.front().level);
}

}  // namespace hc
