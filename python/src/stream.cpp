// SPDX-License-Identifier: Apache-2.0
// Messages without a module: links read by a script, and running graphs.
#include <pybind11/stl.h>

#include <chrono>
#include <optional>

#include <client/graph_client.h>
#include <client/running.h>
#include <client/tap.h>
#include <hc/base/clock.h>
#include <hc/compress/compress.h>
#include <hc/link/link.h>
#include <record/reader.h>

#include "message.h"
#include "python.h"

namespace python {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kSlice{50};  // a wait checks for Ctrl-C at this period

hc::LinkOptions link_options(const std::optional<std::uint64_t>& limit) {
  hc::LinkOptions options;
  if (limit) options.limits.element_bytes = *limit;
  options.log = [](hc::Level level, std::string_view line) {
    const char* name = level == hc::Level::Info ? "info" : "warning";
    const py::gil_scoped_acquire inside;
    try {
      py::module_::import("logging").attr("getLogger")("hypercolumn").attr(name)("%s", line);
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("hypercolumn's log");
    }
  };
  return options;
}

/// A source of messages for a script.
class Stream {
 public:
  /// @param graph  if given, `text` is one of its ports; else a URI or a file.
  Stream(const std::string& text, const std::optional<std::uint64_t>& limit,
         const hc::RunningGraph* graph = nullptr)
      : keeper_(std::make_shared<Keeper>(Keeper{text})) {
    std::optional<hc::Result<std::unique_ptr<hc::Source>>> opened;
    {
      const py::gil_scoped_release outside;
      const auto options = link_options(limit);
      opened.emplace(graph != nullptr ? hc::open_tap(*graph, text, options)
                                      : hc::record::open_source(text, options));
    }
    if (!*opened) raise({opened->error().code, text + ": " + opened->error().detail});
    source_ = std::move(**opened);
    is_in_memory_ = source_->wake_descriptor() >= 0;
  }

  /// The next message; None after `seconds` without one. Raises StopIteration at the end.
  py::object take(const std::optional<double>& seconds) {
    // Messages in memory are taken with the GIL held: releasing it would cost more.
    if (source_ != nullptr && is_in_memory_ && !is_busy_) {
      hc::Message message;
      const auto got = source_->take(message);
      if (!got) raise({got.error().code, keeper_->name + ": " + got.error().detail});
      if (*got == hc::Got::Message && message.plain()) return wrapped(std::move(message));
      if (*got == hc::Got::Message) return wrapped(value_or_raise(hc::expand(message)));
    }
    const auto until = seconds ? Clock::now() + hc::duration(*seconds) : Clock::time_point::max();
    while (true) {
      hc::Message message;
      const hc::Got got = try_take(message);
      if (got == hc::Got::End) throw py::stop_iteration();
      if (got == hc::Got::Message) return wrapped(std::move(message));
      if (Clock::now() >= until) return py::none();
      check_signals();
    }
  }

  void close() {
    if (is_busy_) raise({hc::Code::Invalid, "another thread reads " + keeper_->name});
    source_.reset();
  }

 private:
  py::object wrapped(hc::Message message) const {
    auto object = py::reinterpret_steal<py::object>(wrap(std::move(message), keeper_));
    if (!object) throw py::error_already_set();
    return object;
  }

  /// Takes a message, or waits for kSlice, without the GIL.
  hc::Got try_take(hc::Message& message) {
    if (source_ == nullptr) return hc::Got::End;
    if (is_busy_) raise({hc::Code::Invalid, "another thread reads " + keeper_->name});
    is_busy_ = true;
    hc::Result<hc::Got> got = hc::Got::Nothing;
    {
      const py::gil_scoped_release outside;
      got = source_->take(message);
      if (got && *got == hc::Got::Nothing) {
        if (auto ready = source_->wait(-1, kSlice); !ready)
          got = ready.error();
        else if (*ready)
          got = source_->take(message);
      }
      if (got && *got == hc::Got::Message && !message.plain()) {
        auto plain = hc::expand(message);
        if (plain)
          message = std::move(*plain);
        else
          got = plain.error();
      }
    }
    is_busy_ = false;
    if (!got) raise({got.error().code, keeper_->name + ": " + got.error().detail});
    return *got;
  }

  std::unique_ptr<hc::Source> source_;
  std::shared_ptr<Keeper> keeper_;
  bool is_in_memory_ = false;
  bool is_busy_ = false;  // a thread waits without the GIL
};

/// The next message for a loop, without pybind11's dispatch, which would double the time.
PyObject* next(PyObject* self) {
  return py::cast<Stream&>(py::handle(self)).take(std::nullopt).release().ptr();
}

std::vector<std::string> ask(const hc::RunningGraph& graph,
                             const std::vector<std::string>& commands) {
  std::optional<hc::Result<hc::GraphAnswer>> answer;
  {
    const py::gil_scoped_release outside;
    answer.emplace(hc::ask(graph, commands));
  }
  if (!*answer) raise(answer->error());
  if ((*answer)->is_ok) return (*answer)->rows;
  std::string text;
  for (const auto& row : (*answer)->rows) text += (text.empty() ? "" : "\n") + row;
  raise({hc::Code::Invalid, text});
}

}  // namespace

void add_streams(py::module_& extension) {
  py::class_<Stream> stream(
      extension, "Stream",
      "Iterates over the messages of a recording or link; also a context manager.");
  stream
      .def(py::init<const std::string&, const std::optional<std::uint64_t>&>(), py::arg("uri"),
           py::arg("limit") = py::none())
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", [](Stream& self) { return self.take(std::nullopt); })
      .def("take", &Stream::take, py::arg("seconds") = py::none(),
           "The next message; None after `seconds` without one. Raises StopIteration at the end.")
      .def("close", &Stream::close, "Ends the link.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Stream& self, const py::args&) { self.close(); });
  reinterpret_cast<PyTypeObject*>(stream.ptr())->tp_iternext = guarded<next>;
  py::class_<hc::RunningGraph>(extension, "RunningGraph")
      .def_readonly("name", &hc::RunningGraph::name)
      .def_readonly("process", &hc::RunningGraph::process)
      .def_property_readonly("state_uri", &hc::RunningGraph::state_uri)
      .def("__repr__", &hc::RunningGraph::text);
  extension.def("find_running", [] { return hc::find_running(); });
  extension.def("ask", ask);
  extension.def("open_tap", [](const hc::RunningGraph& graph, const std::string& port) {
    return std::make_unique<Stream>(port, std::nullopt, &graph);
  });
}

}  // namespace python
