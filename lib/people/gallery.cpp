// SPDX-License-Identifier: Apache-2.0
#include <people/gallery.h>

namespace hc::people {

Embedding mean(const std::vector<Embedding>& views) {
  Embedding sum = {};
  for (const auto& view : views)
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += view[i];
  for (float& number : sum) number /= static_cast<float>(views.size());
  return sum;
}

int Gallery::add(const std::string& name, const Embedding& embedding) {
  const int next = static_cast<int>(numbers_.size()) + 1;
  const int number = numbers_.try_emplace(name, next).first->second;
  people_[name] = {number, embedding};
  return number;
}

std::optional<Gallery::Match> Gallery::find(const Embedding& embedding, float most) const {
  std::optional<Match> best;
  for (const auto& [name, person] : people_) {
    const float apart = distance(embedding, person.embedding);
    if (apart < most && (!best || apart < best->distance)) best = {person.number, apart};
  }
  return best;
}

std::map<std::string, int> Gallery::names() const {
  std::map<std::string, int> names;
  for (const auto& [name, person] : people_) names[name] = person.number;
  return names;
}

}  // namespace hc::people
