// SPDX-License-Identifier: Apache-2.0
#include "chrome_trace.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace tool {
namespace {

using What = hc::TraceEvent::What;

/// Events in the JSON of Chrome's trace viewer; a process for each module.
class ChromeTrace {
 public:
  explicit ChromeTrace(const Traced& traced) {
    int process = 0;
    for (const auto& [name, events] : traced.events) {
      ++process;
      for (const auto& event : events) {
        first_ = std::min(first_, event.moment);
        if (event.what == What::Sent) senders_[event.key()].push_back({process, event.moment});
      }
    }
  }

  void add_module(const std::string& name, const std::vector<hc::TraceEvent>& events) {
    ++process_;
    write("M", process_, "process_name", first_, {{"args", {{"name", name}}}});
    depth_ = 0;
    for (const auto& event : events) add(event);
  }

  [[nodiscard]] std::string text() && {
    if (text_.back() == ',') text_.pop_back();
    return std::move(text_) + "\n]}\n";
  }

 private:
  using json = nlohmann::json;
  struct Sender {
    int process;
    hc::Time moment;
  };

  void add(const hc::TraceEvent& event) {
    const json header = {
        {"src", event.src}, {"seq", event.seq}, {"time", hc::unix_nanoseconds(event.time)}};
    if (event.what == What::Began && event.port.empty()) {
      write("B", process_, "timer", event.moment, json::object());
      ++depth_;
    } else if (event.what == What::Began) {
      write("B", process_, event.port, event.moment, {{"args", header}});
      ++depth_;
      add_arrow(event);
    } else if (event.what == What::Ended && depth_ > 0) {
      write("E", process_, event.port, event.moment, json::object());
      --depth_;
    } else if (event.what == What::Took || event.what == What::Sent) {
      write("i", process_, (event.what == What::Took ? "took " : "sent ") + event.port,
            event.moment, {{"s", "t"}, {"args", header}});
    }
  }

  /// From the last sender of a message to its handler.
  void add_arrow(const hc::TraceEvent& event) {
    const Sender* last = nullptr;
    for (const auto& sender : senders_[event.key()])
      if (sender.moment <= event.moment && sender.process != process_ &&
          (last == nullptr || sender.moment > last->moment))
        last = &sender;
    if (last == nullptr) return;
    write("s", last->process, "message", last->moment, {{"id", ++arrows_}});
    write("f", process_, "message", event.moment, {{"id", arrows_}, {"bp", "e"}});
  }

  void write(const char* kind, int process, const std::string& what, hc::Time moment, json more) {
    more.update({{"ph", kind},
                 {"pid", process},
                 {"tid", 1},
                 {"cat", "message"},
                 {"name", what},
                 {"ts", static_cast<double>((moment - first_).count()) * 1e-3}});  // [µs]
    text_ += "\n" + more.dump() + ",";
  }

  std::string text_ = R"({"displayTimeUnit":"ms","traceEvents":[)";
  std::map<hc::MessageKey, std::vector<Sender>> senders_;
  hc::Time first_ = hc::Time::max();
  int process_ = 0, arrows_ = 0;
  int depth_ = 0;  // of handlers; the trace may begin within one
};

}  // namespace

std::string to_chrome_trace(const Traced& traced) {
  ChromeTrace trace(traced);
  for (const auto& [name, events] : traced.events) trace.add_module(name, events);
  return std::move(trace).text();
}

}  // namespace tool
