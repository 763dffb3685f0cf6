// SPDX-License-Identifier: Apache-2.0
// hypercolumn._hypercolumn.Module, the base of Module in hypercolumn/module.py.
#include <pybind11/chrono.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <functional>
#include <optional>
#include <utility>

#include "kind.h"
#include "message.h"
#include "output.h"
#include "program.h"

namespace python {
namespace {

using Input = hc::Input<hc::AnyKind>;
constexpr std::size_t kMostTogether = 8;
/// Up to this size, messages can be so frequent that taking the GIL for each matters [byte].
constexpr std::size_t kQuick = 4096;

struct PyInput {
  std::string name;
  Input input;
};

/// A parameter of any type.
struct PyParameter {
  const Program* program;
  std::shared_ptr<const hc::ParameterState> state;

  [[nodiscard]] py::object value() const {
    program->check_thread();  // the loop sets the value without the GIL
    return std::visit([](const auto& each) -> py::object { return py::cast(each); }, state->value);
  }
};

/// A timer and its module.
struct PyTimeout {
  const Program* program;
  hc::Timeout timeout;

  void restart(std::optional<double> seconds) {
    program->check_thread();
    if (seconds)
      timeout.restart(hc::duration(*seconds));
    else
      timeout.restart();
  }
  void stop() {
    program->check_thread();
    timeout.stop();
  }
};

std::chrono::nanoseconds period_of(double seconds) {
  if (!(seconds > 0)) raise({hc::Code::Invalid, "a period must be above 0 s"});
  return hc::duration(seconds);
}

/// A handler of messages: the Python function, and a Keeper for each input.
struct Handler {
  Program* program;
  Function function;
  std::vector<std::shared_ptr<Keeper>> keepers;

  Handler(Program& owner, const py::object& callee, const std::vector<PyInput>& inputs)
      : program(&owner), function(hold(callee)) {
    for (const auto& input : inputs)
      keepers.push_back(std::make_shared<Keeper>(Keeper{input.name, callee.ptr(), {}, false}));
  }

  /// Calls the function with messages, one of each input.
  template <std::size_t... kIndex, typename... Messages>
  void operator()(std::index_sequence<kIndex...>, Messages&&... messages) const {
    const bool is_quick = (... && (messages.elements.size() <= kQuick));
    const Program::Inside inside(*program, is_quick);
    const std::array<py::object, sizeof...(Messages)> objects{py::reinterpret_steal<py::object>(
        wrap(std::forward<Messages>(messages), keepers[kIndex]))...};
    for (const auto& each : objects)
      if (!each) program->end_by_error();
    program->call(function.get(), objects[kIndex].ptr()...);
  }
};

void on(Program& program, const PyInput& input, const py::object& function) {
  const Handler handler(program, function, {input});
  program.module().on(input.input, [handler](hc::Message message) {
    handler(std::make_index_sequence<1>(), std::move(message));
  });
}

template <std::size_t... kIndex>
void on_each(std::index_sequence<kIndex...> indices, Program& program,
             const std::vector<PyInput>& inputs, const py::object& function) {
  const Handler handler(program, function, inputs);
  program.module().on(
      hc::together(inputs[kIndex].input...),
      [handler, indices](const auto&... messages) { handler(indices, hc::Message(messages)...); });
}

template <std::size_t kCount = 2>
void on_together(Program& program, const std::vector<PyInput>& inputs, const py::object& function) {
  if constexpr (kCount > kMostTogether) {
    raise({hc::Code::Invalid, "together() takes two to eight inputs"});
  } else if (inputs.size() == kCount) {
    on_each(std::make_index_sequence<kCount>(), program, inputs, function);
  } else {
    on_together<kCount + 1>(program, inputs, function);
  }
}

/// Wraps a Python function without arguments for the loop.
std::function<void()> action(Program& program, const py::object& function) {
  return [&program, held = hold(function)] {
    const Program::Inside inside(program);
    program.call(held.get());
  };
}

PyInput add_input(Program& program, const std::string& name, const Kind& kind,
                  const std::string& doc, bool actor, std::uint32_t keep) {
  return {name, program.module().input(name, hc::AnyKind{kind.types}, doc, {actor, keep})};
}

py::object add_output(const py::object& self, const std::string& name, const Kind& kind,
                      const std::string& doc, bool on_demand, std::uint32_t keep,
                      std::vector<std::string> columns) {
  auto& program = self.cast<Program&>();
  auto& module = program.module();
  module.output(name, hc::AnyKind{{kind.only("an output")}}, doc,
                {on_demand, keep, std::move(columns)});
  return make_output(program, hc::ModuleAccess::outputs(module).back(), self);
}

PyParameter add_parameter(Program& program, const std::string& name, const py::object& initial,
                          const std::string& unit, const std::string& doc,
                          std::optional<double> min, std::optional<double> max, std::int64_t step,
                          std::vector<std::string> choices, bool positional, bool fixed) {
  hc::ParameterOptions options;
  if (min) options.min = *min;
  if (max) options.max = *max;
  options.step = step;
  options.choices = std::move(choices);
  options.positional = positional;
  options.fixed = fixed;
  auto& module = program.module();
  if (py::isinstance<py::bool_>(initial))
    module.parameter(name, initial.cast<bool>(), unit, doc, options);
  else if (py::isinstance<py::int_>(initial))
    module.parameter(name, initial.cast<std::int64_t>(), unit, doc, options);
  else if (py::isinstance<py::float_>(initial))
    module.parameter(name, initial.cast<double>(), unit, doc, options);
  else
    module.parameter(name, initial.cast<std::string>(), unit, doc, options);
  return {&program, hc::ModuleAccess::parameters(module).back()};
}

void every(Program& program, const py::object& period, const py::object& function) {
  auto& module = program.module();
  if (py::isinstance<PyParameter>(period)) {
    const auto& state = period.cast<const PyParameter&>().state;
    if (!std::holds_alternative<double>(state->value))
      raise({hc::Code::Invalid, "a rate is a number: parameter " + state->name});
    module.every(hc::Parameter<double>(state), action(program, function));
  } else {
    module.every(period_of(period.cast<double>()), action(program, function));
  }
}

using Pose = py::array_t<double, py::array::c_style>;

py::object array_of(const Eigen::Isometry3d& T) {
  constexpr py::ssize_t kSide = 4;
  Pose pose({kSide, kSide});
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      pose.mutable_at(row, column) = T.matrix()(row, column);
  return pose;
}

/// A frame by name or number; valid during the call.
hc::frames::Frame frame_of(const py::object& frame) {
  if (py::isinstance<py::str>(frame)) return frame.cast<std::string_view>();
  return frame.cast<std::int32_t>();
}

/// The frames of a module's graph, owned by the module.
class Frames {
 public:
  Frames(Program& program) : program_(program) { program.frames(); }

  py::object lookup(const py::object& target, const py::object& source, std::int64_t time) {
    return array_of(value_or_raise(
        program_.frames().lookup(frame_of(target), frame_of(source), hc::unix_time(time))));
  }
  py::object nearest(const py::object& target, const py::object& source, std::int64_t time) {
    return array_of(
        program_.frames().nearest(frame_of(target), frame_of(source), hc::unix_time(time)));
  }
  void when_known(const py::object& target, const py::object& source, std::int64_t time,
                  const py::object& function) {
    auto handler = [&program = program_,
                    held = hold(function)](const hc::Result<Eigen::Isometry3d>& T) {
      const Program::Inside inside(program);
      const py::object pose = T ? array_of(*T) : py::none();
      program.call(held.get(), pose.ptr());
    };
    const auto to = frame_of(target), from = frame_of(source);
    program_.work("when_known()",
                  [&] { program_.frames().when_known(to, from, hc::unix_time(time), handler); });
  }

 private:
  Program& program_;
};

/// The messages of an input in a script.
class Messages {
 public:
  Messages(Program& program, const PyInput& input)
      : program_(program), keeper_(std::make_shared<Keeper>(Keeper{input.name})) {}

  py::object next() {
    auto message = program_.next(keeper_->name);
    if (!message) throw py::stop_iteration();
    auto object = py::reinterpret_steal<py::object>(wrap(std::move(*message), keeper_));
    if (!object) throw py::error_already_set();
    return object;
  }

 private:
  Program& program_;
  std::shared_ptr<Keeper> keeper_;
};

void keep_rate(Program& program, double rate) {
  program.work("keep_rate()", [&] { program.module().keep_rate(rate); });
}

void add_ports(py::module_& extension) {
  py::class_<PyInput>(extension, "Input",
                      "An input port. In a script, `for message in input:` takes its messages.",
                      py::dynamic_attr())
      .def_readonly("name", &PyInput::name, "Its name.")
      .def("__iter__",
           [](const py::object& self) { return self.attr("module").attr("_pull")(self); });
  py::class_<Messages>(extension, "Messages", "The messages of an input in a script.")
      .def(py::init<Program&, const PyInput&>(), py::keep_alive<1, 2>())
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &Messages::next);
  py::class_<PyParameter>(extension, "Parameter", "A parameter of the module.")
      .def_property_readonly("value", &PyParameter::value, "The current value.")
      .def_property_readonly(
          "name", [](const PyParameter& each) { return each.state->name; }, "Its name.");
  py::class_<PyTimeout>(extension, "Timeout",
                        "A timer that fires once each time it is started: Module.after().")
      .def("restart", &PyTimeout::restart, py::arg("seconds") = py::none(),
           "Restarts the timer, with the same or another time.")
      .def("stop", &PyTimeout::stop, "Stops the timer.");
  py::class_<Frames>(extension, "ModuleFrames",
                     "The tree of frames of a module's graph (doc/frames.md). Declares a parameter "
                     "and an input `frames`.")
      .def(py::init<Program&>(), py::keep_alive<1, 2>())
      .def("lookup", &Frames::lookup, py::arg("target"), py::arg("source"), py::arg("time"),
           "The (4, 4) matrix that transforms points from source to target at a time.")
      .def("nearest", &Frames::nearest, py::arg("target"), py::arg("source"), py::arg("time"),
           "The same, with the nearest known pose of joints without one at that time.")
      .def("when_known", &Frames::when_known, py::arg("target"), py::arg("source"), py::arg("time"),
           py::arg("handler"),
           "Calls a function with the matrix as soon as it is known; with None if it will not be.");
}

using PyModule = py::class_<Program>;

/// What hypercolumn/module.py wraps.
void add_private(PyModule& module) {
  module.def(py::init<std::string, std::string, bool, bool, bool>())
      .def("_input", add_input)
      .def("_output", add_output)
      .def("_parameter", add_parameter, py::keep_alive<0, 1>())
      .def("_on", on)
      .def("_on_together", on_together<>)
      .def("_every", every)
      .def(
          "_after",
          [](Program& self, double seconds, const py::object& function) {
            return PyTimeout{&self,
                             self.module().after(hc::duration(seconds), action(self, function))};
          },
          py::keep_alive<0, 1>())
      .def("_generate",
           [](Program& self, const py::object& function) {
             self.module().generate(action(self, function));
           })
      .def("_on_start",
           [](Program& self, const py::object& function) {
             self.module().on_start(action(self, function));
           })
      .def("_on_end",
           [](Program& self, const py::object& function) {
             self.module().on_end(action(self, function));
           })
      .def("_run", &Program::run)
      .def("_begin", &Program::begin)
      .def("_end", &Program::end)
      .def_property_readonly("_is_pulled", &Program::is_pulled);
}

void add_public(PyModule& module) {
  module
      .def("keep_rate", keep_rate, py::arg("rate"),
           "For generators: waits until the next period of a rate begins [Hz].")
      .def(
          "stop", [](Program& self) { self.module().stop(); },
          "Ends the module when the handler that calls this has returned; in a script, its loop.")
      .def(
          "log",
          [](const Program& self, const std::string& line, const std::string& level) {
            const auto known = hc::level_named(level);
            if (!known)
              throw py::value_error("level must be info, warning, error, result or notice, not " +
                                    level);
            self.log(line, *known);
          },
          py::arg("line"), py::arg("level") = "info",
          "Logs a line to standard error. Lines of other levels than info are also reported to `hc "
          "run`, which repeats results and errors at its end. A notice is only for the person at "
          "the terminal.")
      .def(
          "log_once",
          [](Program& self, const std::string& kind, const std::string& line) {
            self.module().log_once(kind, line);
          },
          py::arg("kind"), py::arg("line"),
          "Logs the first problem of a kind and counts the others; the counts are logged at the "
          "end.")
      .def(
          "now", [](Program& self) { return hc::unix_nanoseconds(self.module().now()); },
          "The time for new messages [ns since the Unix epoch]: the machine's, or with --clock "
          "messages that of the messages.")
      .def_property_readonly(
          "focus", [](Program& self) { return self.module().focus(); },
          "Number of the system mode in focus; 0: none.")
      .def_property_readonly(
          "has_focus", [](Program& self) { return self.module().has_focus(); },
          "Whether the module's mode has the focus.")
      .def_property_readonly(
          "name", [](const Program& self) { return self.name(); }, "Its name.")
      .def_property_readonly(
          "instance", [](Program& self) { return self.module().instance(); },
          "Its name in the graph.");
}

}  // namespace

void add_modules(py::module_& extension) {
  add_ports(extension);
  PyModule module(extension, "Module", "Base of hypercolumn.Module.");
  add_private(module);
  add_public(module);
  extension.def("exit_with", exit_with);
}

}  // namespace python
