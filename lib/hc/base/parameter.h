// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parameters of a module: declared with unit, default and range; set on the command line and,
// unless they are fixed, while the module runs.

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <hc/base/result.h>

namespace hc {

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

/// Constraints on a parameter's value, and how it is set.
struct ParameterOptions {
  double min = -std::numeric_limits<double>::infinity();  ///< of a number
  double max = std::numeric_limits<double>::infinity();   ///< of a number
  std::int64_t step = 1;  ///< of an integer that has a minimum: the values are min, min + step, …
  std::vector<std::string> choices = {};  ///< of a string; empty: any string
  bool positional = false;  ///< may be given without its name, in the order of declaration
  bool fixed = false;       ///< read at start-up only; changing it restarts the module
};

/// A parameter as declared, with its value.
struct ParameterState {
  std::string name;
  std::string unit;  ///< [SI], "" for none
  std::string doc;
  ParameterOptions options;
  ParameterValue default_value;
  ParameterValue value;
  bool is_set = false;  ///< by set(); else it is the default

  /// Sets the value from text: true, false, 12, 0.5, any string.
  ///
  /// Errors: Invalid (wrong type, out of range, not one of the choices).
  Status set(std::string_view text);
};

/// "from 0 to 1", "at least 0"; empty: unrestricted.
std::string range_in_words(const ParameterOptions& options);

/// "bool", "integer", "number", "string"
std::string_view type_name(const ParameterValue& value);

/// The value in the form that set() reads.
std::string text(const ParameterValue& value);

/// A module's handle of a parameter: `*hue` is its current value.
template <typename T>
class Parameter {
 public:
  explicit Parameter(std::shared_ptr<const ParameterState> state) : state_(std::move(state)) {}
  const T& operator*() const { return std::get<T>(state_->value); }
  const T* operator->() const { return &**this; }
  [[nodiscard]] const std::string& name() const { return state_->name; }
  /// Whether the user, or the graph, has given it.
  [[nodiscard]] bool is_set() const { return state_->is_set; }

 private:
  std::shared_ptr<const ParameterState> state_;
};

}  // namespace hc
