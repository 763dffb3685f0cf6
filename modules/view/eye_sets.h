// SPDX-License-Identifier: Apache-2.0
#pragma once
// Matches the images and depths of both eyes that are shown as one image.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <hc/module/matcher.h>
#include <hc/mtp/message.h>

class EyeSets {
 public:
  /// Takes the images of some eyes: for fog first the images and then the depths, left before
  /// right.
  using Take = std::function<void(std::span<const hc::Message>)>;

  /// @param is_pair  both eyes. @param is_fog  with an image of each depth.
  EyeSets(bool is_pair, bool is_fog, const Take& take);

  [[nodiscard]] bool is(bool is_pair, bool is_fog) const {
    return is_pair_ == is_pair && is_fog_ == is_fog;
  }

  /// Whether a message alone is an image to show.
  [[nodiscard]] bool is_whole(const hc::Header& header) const;
  void push(const hc::Message& message);

  /// The names of what is missing to show what was pushed, such as "depth of the right eye";
  /// empty: nothing, or the rest may still come.
  /// @param is_end  nothing more comes.
  [[nodiscard]] std::string missing(bool is_end) const;

 private:
  /// What is shown together.
  struct Group {
    hc::Matcher matcher;
    std::vector<std::uint64_t> came;  // of each place
  };
  struct Place {
    std::size_t group, place;
  };

  [[nodiscard]] Place place_of(const hc::Header& header) const;
  [[nodiscard]] std::string name_of(Place place) const;

  const bool is_pair_, is_fog_;
  std::vector<Group> groups_;
};
