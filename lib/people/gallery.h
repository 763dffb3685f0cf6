// SPDX-License-Identifier: Apache-2.0
#pragma once
// Known people, by name. Pure.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <people/embedding.h>

namespace hc::people {

/// Maximum distance of a face from the person it is taken for. No views of two persons in the
/// photographs of doc/figures.md are nearer.
inline constexpr double kSamePerson = 0.34;

/// The mean of several embeddings, which is nearer to each view of a person than these are to one
/// another.
Embedding mean(const std::vector<Embedding>& views);

/// Known people, each with a number and the mean embedding of some views of the face.
class Gallery {
 public:
  /// @returns  the person's number: from 1 in the order in which names came, never used again for
  ///     another name.
  int add(const std::string& name, const Embedding& embedding);
  void forget(const std::string& name) { people_.erase(name); }

  struct Match {
    int number = 0;
    float distance = 0;
  };
  /// The person nearest to an embedding, if nearer than `most`.
  [[nodiscard]] std::optional<Match> find(const Embedding& embedding, float most) const;
  /// Name and number of all.
  [[nodiscard]] std::map<std::string, int> names() const;

 private:
  struct Person {
    int number = 0;
    Embedding embedding = {};
  };
  std::map<std::string, Person> people_;
  std::map<std::string, int> numbers_;  // also of the forgotten
};

}  // namespace hc::people
