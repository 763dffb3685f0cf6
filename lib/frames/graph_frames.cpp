// SPDX-License-Identifier: Apache-2.0
#include <frames/graph_frames.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <hc/base/format.h>
#include <hc/base/json_string.h>
#include <hc/base/suggestion.h>
#include <hc/base/text.h>
#include <hc/base/words.h>

namespace hc::frames {
namespace {

constexpr std::size_t kMovedWords = 5, kFixedWords = 10;
constexpr std::size_t kMostShown = 40;  // bytes of a word that an error quotes

std::string quoted(std::string_view word) {
  std::string text;
  append_json_string(word.substr(0, kMostShown), text);
  return text;
}

std::int32_t standard_number(std::string_view name) {
  for (const auto& frame : kStandardFrames)
    if (frame.name == name) return frame.number;
  return 0;
}

/// One frame of the text.
struct Entry {
  std::size_t place;  // from 1
  std::string_view name, parent;
  std::int32_t number = 0;
  std::vector<std::string_view> joint;  // the words after the parent

  [[nodiscard]] Error error(Code code, const std::string& what) const {
    return Error{code, "frames: frame " + std::to_string(place) + ", " +
                           std::string(name.substr(0, kMostShown)) + ": " + what};
  }
  /// An error of the tree, with the frame's name prepended.
  [[nodiscard]] Error error(const Error& cause) const {
    constexpr std::string_view kBefore = "frames: ";
    std::string_view detail = cause.detail;
    if (detail.starts_with(kBefore)) detail.remove_prefix(kBefore.size());
    return error(cause.code, std::string(detail));
  }
};

bool is_word(std::string_view word) {
  return std::none_of(word.begin(), word.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == '"' || static_cast<unsigned char>(c) > '~';
  });
}

Result<Entry> read_entry(std::size_t place, std::string_view text) {
  const auto words = words_of(text, " ");
  const std::string which = "frames: frame " + std::to_string(place);
  for (auto word : words)
    if (!is_word(word))
      return Error{Code::Malformed, which + ": " + quoted(word) + " is not a valid word"};
  if (words.size() != kMovedWords && words.size() != kFixedWords)
    return Error{Code::Malformed,
                 hc::format("{}: {} has {} words, not {} (moved) or {} (fixed)", which,
                            quoted(words.empty() ? std::string_view() : words.front()),
                            words.size(), kMovedWords, kFixedWords)};
  Entry entry{place, words[0], words[2], 0, {words.begin() + 3, words.end()}};
  if (!read_number(words[1], entry.number) || entry.number < 0 || entry.number >= kFrameNumbers)
    return entry.error(Code::Malformed,
                       hc::format("a frame's number is from 0 (none) to {}, not {}",
                                  kFrameNumbers - 1, quoted(words[1])));
  const std::int32_t standard = standard_number(entry.name);
  if (standard != 0 && entry.number != standard)
    return entry.error(Code::Malformed, "its number is " + std::to_string(standard) + ", not " +
                                            std::to_string(entry.number));
  for (const auto& frame : kStandardFrames)
    if (frame.number == entry.number && frame.name != entry.name)
      return entry.error(Code::Malformed, "the number " + std::to_string(frame.number) +
                                              " is that of " + std::string(frame.name));
  return entry;
}

Result<Eigen::Isometry3d> fixed_joint(const Entry& entry) {
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!read_number(entry.joint[i], numbers[i]) || !std::isfinite(numbers[i]))
      return entry.error(Code::Malformed, quoted(entry.joint[i]) + " is not a number");
  Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(q.coeffs().stableNorm() - 1) <= kRotationTolerance))
    return entry.error(Code::Malformed, "its quaternion is not of length 1");
  auto joint = rigid(Eigen::Vector3d(numbers[0], numbers[1], numbers[2]), q);
  if (!joint) return entry.error(joint.error());
  return joint;
}

Result<Mover> moved_joint(const Entry& entry, std::int32_t parent_number) {
  std::string_view output = entry.joint[0];
  auto dot = output.find('.');
  if (dot == 0 || dot == std::string_view::npos || dot + 1 == output.size() ||
      output.find('.', dot + 1) != std::string_view::npos)
    return entry.error(Code::Malformed, quoted(output) + " is not MODULE.PORT");
  std::int32_t source = 0;
  if (!read_number(entry.joint[1], source) || source < 0)
    return entry.error(Code::Malformed, quoted(entry.joint[1]) + " is not a src");
  const bool numbered = entry.number != 0 && parent_number != 0;
  return Mover{std::string(entry.parent), std::string(entry.name), std::string(output), source,
               numbered ? kFrameNumbers * parent_number + entry.number : 0};
}

/// Refuses two frames that are moved by the same messages, but have no numbers to distinguish them.
Status check_movers(const std::vector<Mover>& movers) {
  std::map<std::int32_t, const Mover*> unnumbered;
  for (const auto& mover : movers) {
    if (mover.coord != 0) continue;
    if (auto [other, is_new] = unnumbered.emplace(mover.source, &mover); !is_new)
      return Error{Code::Malformed,
                   hc::format("frames: {} and {} are moved by messages of the src {}, so they and "
                              "their parents need numbers",
                              other->second->child, mover.child, mover.source)};
  }
  return {};
}

}  // namespace

Result<const Mover*> GraphFrames::mover_of(std::int32_t source, std::int32_t coord) const {
  bool is_known = false;  // a mover has this src
  const Mover *by_coord = nullptr, *by_source = nullptr;
  for (const auto& mover : movers) {
    is_known = is_known || (source != 0 && mover.source == source);
    if (mover.coord != 0 && mover.coord == coord) by_coord = &mover;
    if (mover.coord == 0 && mover.source == source) by_source = &mover;
  }
  if (by_coord != nullptr && (by_coord->source == source || !is_known)) return by_coord;
  if (by_source != nullptr) return by_source;
  return Error{Code::NotFound, "frames: no frame is moved by messages from " +
                                   std::to_string(source) + " with coord " + std::to_string(coord)};
}

Result<GraphFrames> read_frames(std::string_view text, const Memory& memory) {
  const auto parts = words_of(text, ";");
  if (parts.size() > kMostFrames)
    return Error{Code::TooLarge, "frames: " + std::to_string(parts.size()) +
                                     " frames are more than " + std::to_string(kMostFrames)};
  GraphFrames frames;
  std::vector<Entry> entries;
  std::map<std::string_view, std::int32_t> numbers;
  if (words_of(text, " ").empty()) return frames;
  for (auto part : parts) {
    auto entry = HC_TRY(read_entry(entries.size() + 1, part));
    auto added =
        entry.number == 0 ? frames.tree.add(entry.name) : frames.tree.add(entry.number, entry.name);
    if (!added) return entry.error(added.error());
    numbers[entry.name] = entry.number;
    entries.push_back(std::move(entry));
  }
  std::string_view root;
  for (const auto& entry : entries) {
    if (numbers.contains(entry.parent)) continue;
    if (!root.empty()) {
      std::vector<std::string> known(numbers.size());
      std::transform(numbers.begin(), numbers.end(), known.begin(),
                     [](const auto& each) { return std::string(each.first); });
      return entry.error(Code::Malformed, "no frame " + quoted(entry.parent) +
                                              suggestion(entry.parent, known) + "; the root is " +
                                              std::string(root));
    }
    root = entry.parent;
    const std::int32_t number = standard_number(root);
    auto added = number == 0 ? frames.tree.add(root) : frames.tree.add(number, root);
    if (!added) return entry.error(added.error());
    numbers[root] = number;
  }
  for (const auto& entry : entries) {
    Status joined;
    if (entry.joint.size() + 3 == kFixedWords) {
      auto joint = HC_TRY(fixed_joint(entry));
      joined = frames.tree.fix(entry.parent, entry.name, joint);
    } else {
      auto mover = HC_TRY(moved_joint(entry, numbers.at(entry.parent)));
      frames.movers.push_back(std::move(mover));
      joined = frames.tree.join(entry.parent, entry.name, memory);
    }
    if (!joined) return entry.error(joined.error());
  }
  HC_TRY(check_movers(frames.movers));
  return frames;
}

}  // namespace hc::frames
