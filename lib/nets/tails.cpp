// SPDX-License-Identifier: Apache-2.0
#include <nets/tails.h>

namespace hc::nets {

Tails::Tails(const Layers& layers) : layers_(layers), uses_(layers.tensors.size()) {
  for (std::size_t i = 0; i < layers.layers.size(); ++i)
    for (const int input : layers.layers[i].inputs)
      uses_[static_cast<std::size_t>(input)].push_back(i);
  // An output is used by the caller, too.
  for (const int output : layers.outputs)
    uses_[static_cast<std::size_t>(output)].push_back(layers.layers.size());
}

std::optional<std::size_t> Tails::only_use(int tensor) const {
  const auto& uses = uses_[static_cast<std::size_t>(tensor)];
  if (uses.size() != 1 || uses[0] == layers_.layers.size()) return std::nullopt;
  return uses[0];
}

Tail Tails::after(const Layer& convolution,
                  const std::function<bool(int tensor)>& is_computed) const {
  Tail tail{.activation = convolution.activation, .output = convolution.output};
  while (!tail.activation) {
    const auto use = only_use(tail.output);
    if (!use) break;
    const Layer& next = layers_.layers[*use];
    switch (next.kind) {
      case Kind::Add: {
        const int other = next.inputs[next.inputs[0] == tail.output ? 1 : 0];
        if (tail.plus || !is_computed(other)) return tail;
        tail.plus = other;
        tail.activation = next.activation;
        break;
      }
      case Kind::Prelu:
        tail.slopes = next.inputs[1];
        [[fallthrough]];
      case Kind::Relu:
      case Kind::Relu6:
        tail.activation = next.kind;
        break;
      default:
        return tail;
    }
    tail.output = next.output;
    tail.layers.push_back(*use);
  }
  return tail;
}

}  // namespace hc::nets
