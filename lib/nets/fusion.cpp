// SPDX-License-Identifier: Apache-2.0
#include <nets/fusion.h>

namespace hc::nets {

Fusion::Fusion(const Layers& layers)
    : layers_(layers), uses_(layers.tensors.size()), ready_(layers.tensors.size()) {
  for (std::size_t i = 0; i < layers.layers.size(); ++i) {
    for (const int input : layers.layers[i].inputs) {
      auto& [count, last] = uses_[static_cast<std::size_t>(input)];
      ++count;
      last = i;
    }
    ready_[static_cast<std::size_t>(layers.layers[i].output)] = i + 1;
  }
}

std::optional<std::size_t> Fusion::only_use(int tensor) const {
  const auto& [count, last] = uses_[static_cast<std::size_t>(tensor)];
  for (const int output : layers_.outputs)  // the caller uses it, too
    if (output == tensor) return std::nullopt;
  return count == 1 ? std::optional(last) : std::nullopt;
}

Fused Fusion::of(std::size_t convolution) const {
  const Layer& layer = layers_.layers[convolution];
  Fused fused;
  fused.activation = layer.activation;
  fused.output = layer.output;
  while (!fused.activation) {
    const auto use = only_use(fused.output);
    if (!use) break;
    const Layer& next = layers_.layers[*use];
    switch (next.kind) {
      case Kind::Add: {
        const int other = next.inputs[next.inputs[0] == fused.output ? 1 : 0];
        if (fused.addend || ready_[static_cast<std::size_t>(other)] > convolution) return fused;
        fused.addend = other;
        fused.activation = next.activation;
        break;
      }
      case Kind::Prelu:
        fused.slopes = next.inputs[1];
        [[fallthrough]];
      case Kind::Relu:
      case Kind::Relu6:
        fused.activation = next.kind;
        break;
      default:
        return fused;
    }
    fused.output = next.output;
    fused.layers.push_back(*use);
  }
  return fused;
}

}  // namespace hc::nets
