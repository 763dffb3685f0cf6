// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes small files of TensorFlow Lite, right and wrong ones, for tests of their reader.
// Source: tensorflow/lite/schema/schema.fbs; https://flatbuffers.dev/internals

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nets/layers.h>

namespace hc::nets::testing {

/// Writes FlatBuffers from front to back: what a table refers to is behind it.
class FlatWriter {
 public:
  /// Writes something, and returns where it begins.
  using Child = std::function<std::size_t(FlatWriter&)>;
  /// Absent, a number, or what an offset leads to.
  using Field = std::variant<std::monostate, int, Child>;

  std::string bytes;

  template <typename Number>
  void put(Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  std::size_t table(const std::vector<Field>& fields) {
    const std::size_t map = bytes.size();
    put(static_cast<std::uint16_t>(4 + 2 * fields.size()));
    put(static_cast<std::uint16_t>(4 + 4 * fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i)
      put(static_cast<std::uint16_t>(fields[i].index() > 0 ? 4 + 4 * i : 0));
    const std::size_t begin = bytes.size();
    put(static_cast<std::int32_t>(begin - map));
    for (const Field& field : fields)
      put(std::holds_alternative<int>(field) ? std::get<int>(field) : 0);
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (const auto* child = std::get_if<Child>(&fields[i])) lead(begin + 4 + 4 * i, *child);
    return begin;
  }
  static Child in(std::vector<Field> fields) {
    return [fields = std::move(fields)](FlatWriter& to) { return to.table(fields); };
  }
  static Child vector(std::string data, std::size_t count) {
    return [data = std::move(data), count](FlatWriter& to) {
      const std::size_t begin = to.bytes.size();
      to.put(static_cast<std::uint32_t>(count));
      to.bytes += data;
      return begin;
    };
  }
  template <typename Number>
  static std::string text(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
  }
  static Child vector(const std::vector<int>& numbers) {
    return vector(text(numbers), numbers.size());
  }
  static Child vector(std::vector<Child> tables) {
    return [tables = std::move(tables)](FlatWriter& to) {
      const std::size_t begin = to.bytes.size();
      to.put(static_cast<std::uint32_t>(tables.size()));
      to.bytes.append(4 * tables.size(), '\0');
      for (std::size_t i = 0; i < tables.size(); ++i) to.lead(begin + 4 + 4 * i, tables[i]);
      return begin;
    };
  }
  void lead(std::size_t place, const Child& child) {
    const auto offset = static_cast<std::uint32_t>(child(*this) - place);
    std::memcpy(bytes.data() + place, &offset, sizeof offset);
  }
};

struct TinyTensor {
  std::vector<int> shape;
  int type = 0;      ///< 0: f32, 1: f16, 2: i32
  std::string data;  ///< of a constant
};
struct TinyOperator {
  int code = 0;
  std::vector<int> inputs;
  int output = 0;
  std::vector<FlatWriter::Field> options;
};

/// A file whose first tensor is its input.
inline std::string tflite(const std::vector<TinyTensor>& tensors,
                          const std::vector<TinyOperator>& operators,
                          const std::vector<int>& outputs) {
  std::vector<FlatWriter::Child> codes, all, steps, buffers;
  for (const TinyTensor& each : tensors) {
    const int buffer = static_cast<int>(buffers.size());
    all.push_back(FlatWriter::in({FlatWriter::vector(each.shape), each.type, buffer}));
    buffers.push_back(each.data.empty()
                          ? FlatWriter::in({})
                          : FlatWriter::in({FlatWriter::vector(each.data, each.data.size())}));
  }
  for (const TinyOperator& each : operators) {
    const int code = static_cast<int>(codes.size());
    codes.push_back(FlatWriter::in({each.code, {}, {}, each.code}));
    steps.push_back(FlatWriter::in({code,
                                    FlatWriter::vector(each.inputs),
                                    FlatWriter::vector(std::vector<int>{each.output}),
                                    {},
                                    FlatWriter::in(each.options)}));
  }
  const auto graph =
      FlatWriter::in({FlatWriter::vector(std::move(all)), FlatWriter::vector(std::vector<int>{0}),
                      FlatWriter::vector(outputs), FlatWriter::vector(std::move(steps))});
  FlatWriter writer;
  writer.bytes = std::string("\0\0\0\0TFL3", 8);
  writer.lead(0, FlatWriter::in({3,
                                 FlatWriter::vector(std::move(codes)),
                                 FlatWriter::vector(std::vector<FlatWriter::Child>{graph}),
                                 {},
                                 FlatWriter::vector(std::move(buffers))}));
  return writer.bytes;
}

}  // namespace hc::nets::testing
