// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/semi_global.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

// Compiled once for each kind of processor. Vectors of unknown length cannot be kept in arrays.
#define HWY_WANT_AVX3_DL
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/stereo/semi_global.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hc::vision::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Byte = std::uint8_t;

constexpr int kPlanes = 3;  // bytes of a census word
constexpr Byte kNever = 255;
// A neutral matching cost for partners outside the right image, so that the paths propagate the
// disparities of neighbours.
constexpr Byte kOutside = 8;

constexpr std::size_t round_up(std::size_t value, std::size_t unit) {
  return (value + unit - 1) / unit * unit;
}

/// The minimum of all lanes of a vector, in each lane of a vector of `d`. Folds first, since halves
/// are cheaper than whole vectors.
template <class D, class V>
HWY_INLINE hn::Vec<D> min_of_lanes(D d, V v) {
  const hn::DFromV<V> folded;
  if constexpr (hn::MaxLanes(folded) > 16) {
    const hn::Half<decltype(folded)> half;
    return min_of_lanes(d, hn::Min(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  } else {
    const hn::Repartition<std::uint16_t, decltype(folded)> d16;
    const V pairs = hn::Min(v, hn::BitCast(folded, hn::ShiftRight<8>(hn::BitCast(d16, v))));
#if HWY_TARGET <= HWY_AVX2
    const __m128i min = _mm_minpos_epu16(pairs.raw);
    if constexpr (hn::MaxLanes(d) == 32) return hn::Vec<D>{_mm256_broadcastb_epi8(min)};
#if HWY_TARGET <= HWY_AVX3
    if constexpr (hn::MaxLanes(d) == 64) return hn::Vec<D>{_mm512_broadcastb_epi8(min)};
#endif
#else
    const auto min = hn::MinOfLanes(d16, hn::BitCast(d16, pairs));
    return hn::Set(d, static_cast<Byte>(hn::GetLane(min)));
#endif
  }
}

/// A vector from the blocks of 16 bytes of `low` followed by `high`, from block `kFirst` on, which
/// is 1 or the last one of `low`.
template <std::size_t kFirst, class D, class V = hn::Vec<D>>
HWY_INLINE V blocks_from(D d, V low, V high) {
  if constexpr (hn::MaxLanes(d) <= 16) return kFirst == 0 ? low : high;
  if constexpr (hn::MaxLanes(d) == 32) return hn::ConcatLowerUpper(d, high, low);
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(d) == 64) return V{_mm512_alignr_epi64(high.raw, low.raw, 2 * kFirst)};
#endif
}

/// The costs of all disparities of a pixel.
template <class D, std::size_t kVectors>
struct Costs {
  using V = hn::Vec<D>;
  static constexpr std::size_t kLanes = hn::MaxLanes(D());

  // Explicit because GCC compiles the implicit one without the instructions of NEON vectors.
  Costs() = default;

  static HWY_INLINE Costs load(const Byte* from) {
    Costs costs;
    for (std::size_t k = 0; k < kVectors; ++k) costs.v[k] = hn::Load(D(), from + k * kLanes);
    return costs;
  }
  HWY_INLINE void store(Byte* to) const {
    for (std::size_t k = 0; k < kVectors; ++k) hn::Store(v[k], D(), to + k * kLanes);
  }

  /// The disparities of vector k.
  static HWY_INLINE V indices(std::size_t k) {
    return hn::Add(hn::Iota(D(), Byte{0}), hn::Set(D(), static_cast<Byte>(k * kLanes)));
  }

  /// Vector k of the costs of the disparities greater by one; `last` is after the last cost.
  HWY_INLINE V next_of(std::size_t k, V last) const {
    const D d;
    const V next = blocks_from<1>(d, v[k], k + 1 == kVectors ? last : v[k + 1]);
    return hn::CombineShiftRightBytes<1>(d, next, v[k]);
  }

  /// For each disparity, the lesser cost of the two next to it.
  HWY_INLINE Costs next_to() const {
    const D d;
    constexpr std::size_t kLastBlock = kLanes <= 16 ? 0 : kLanes / 16 - 1;
    const V never = hn::Set(d, kNever);
    Costs min;
    for (std::size_t k = 0; k < kVectors; ++k) {
      const V before = blocks_from<kLastBlock>(d, k == 0 ? never : v[k - 1], v[k]);
      min.v[k] = hn::Min(hn::CombineShiftRightBytes<15>(d, v[k], before), next_of(k, never));
    }
    return min;
  }

  V v[kVectors];
};

template <class D, std::size_t kVectors>
class Sweep {
 public:
  using V = hn::Vec<D>;
  using C = Costs<D, kVectors>;
  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  static constexpr std::size_t kBytes = kLanes * kVectors;  // of a pixel's costs

  Sweep(const Stripe& stripe, const SemiGlobal& options, Scratch& scratch)
      : stripe_(stripe),
        options_(options),
        width_(static_cast<std::size_t>(stripe.width)),
        plane_(round_up(width_ + kBytes + std::size_t{2} * kReadBeyond, kLanes)) {
    const auto rows =
        static_cast<std::size_t>(stripe.end - std::max(0, stripe.begin - kWarmUpRows));
    const std::size_t row = width_ * kBytes, bytes = width_ + 1 + kLanes;
    const struct {
      Byte** memory;
      std::size_t size;
    } parts[] = {{&left_, kPlanes * plane_},
                 {&right_, kPlanes * plane_},
                 {&rows_[0].costs, row},
                 {&rows_[0].sums, row},
                 {&rows_[0].along, bytes},
                 {&rows_[1].costs, row},
                 {&rows_[1].sums, row},
                 {&rows_[1].along, bytes},
                 {&north_, row},
                 {&north_east_, row + kBytes},
                 {&north_west_, row + rows * kBytes},
                 {&winners_, sizeof(Winner) * width_},
                 {&best_, 2 * bytes},
                 {&window_, 2 * kBytes},
                 {&right_disparities_, bytes},
                 {&down_, bytes},
                 {&down_right_, bytes},
                 {&down_left_, bytes}};
    std::size_t total = 2 * kGuard;
    for (const auto& part : parts) total += round_up(part.size, kGuard) + kGuard;
    scratch.assign(total, 0);
    const auto begin = reinterpret_cast<std::uintptr_t>(scratch.data());
    Byte* next = scratch.data() + (round_up(begin, kGuard) - begin) + kGuard;
    for (const auto& part : parts) {
      *part.memory = next;
      next += round_up(part.size, kGuard) + kGuard;
    }
    north_west_ += rows * kBytes;
  }

  void run() {
    const int first = std::max(0, stripe_.begin - kWarmUpRows);
    for (int y = first; y <= stripe_.end; ++y) {
      Row &row = rows_[y % 2], &above = rows_[(y + 1) % 2];
      if (y < stripe_.end) prepare(y, row);
      if (y == stripe_.end)
        sweep<false, true>(row, above);
      else if (y <= stripe_.begin)
        sweep<true, false>(row, above);
      else
        sweep<true, true>(row, above);
      if (y <= stripe_.begin) continue;
      write_row(stripe_.disparity->ptr<std::uint16_t>(y - 1), stripe_.margin->ptr(y - 1));
      if (is_for_both_) write_right_row(stripe_.right_disparity->ptr<std::uint16_t>(y - 1));
    }
  }

 private:
  // Alignment and padding: vectors read one byte before and after the costs of a pixel.
  static constexpr std::size_t kGuard = 64;
  static constexpr std::size_t kGroup = 16;  // pixels whose winners are found together

  struct Winner {
    Byte disparity, cost, margin;
    std::int8_t fraction;
  };

  /// Results of the walk to the right for the walk to the left.
  struct Row {
    Byte* costs;  // of matching
    Byte* sums;   // over the paths
    Byte* along;  // differences of grey levels to the pixel before
  };

  void prepare(int y, Row& row) {
    census(*stripe_.left, y, 1, left_);
    census(*stripe_.right, y, -1, right_);
    const Byte* grey = stripe_.left->ptr(y + kBorder) + kBorder;
    const auto step = static_cast<std::ptrdiff_t>(stripe_.left->step[0]);
    differences(grey, 1, row.along);
    differences(grey, step, down_);
    differences(grey, step + 1, down_right_);
    differences(grey, step - 1, down_left_);
    // Paths from the north-west come from the previous column: shift the memory by one pixel.
    north_west_ -= kBytes;
  }

  /// Census words of a row: a plane for each byte. @param flip  1, or -1 for the flipped image.
  void census(const cv::Mat& image, int y, int flip, Byte* planes) {
    const D d;
    for (std::size_t x = 0; x < width_; x += kLanes) {
      const auto at = [&](int dy, int dx) {
        return hn::LoadU(d,
                         image.ptr(y + kBorder + dy) + x + static_cast<std::size_t>(kBorder + dx));
      };
      const V mean = hn::AverageRound(hn::AverageRound(at(0, -1), at(0, 1)),
                                      hn::AverageRound(at(-1, 0), at(1, 0)));
      for (std::size_t p = 0; p < kPlanes; ++p) {
        V word = hn::Zero(d);
        for (std::size_t bit = 0; bit < 8; ++bit) {
          const auto [dy, dx] = kCensus[8 * p + bit];
          const V is_less = hn::VecFromMask(d, hn::Lt(at(dy, flip * dx), mean));
          word = hn::Or(word, hn::And(is_less, hn::Set(d, static_cast<Byte>(1 << bit))));
        }
        hn::StoreU(word, d, planes + p * plane_ + x);
      }
    }
  }

  /// The matching costs of a pixel and each of its partners.
  HWY_INLINE C matching_costs(std::size_t x) const {
    const D d;
    C costs;
    const Byte* right = right_ + (width_ - 1 - x);
    V word[kPlanes];
    for (std::size_t p = 0; p < kPlanes; ++p) word[p] = hn::Set(d, left_[p * plane_ + x]);
    for (std::size_t k = 0; k < kVectors; ++k) {
      V sum = hn::Zero(d);
      for (std::size_t p = 0; p < kPlanes; ++p) {
        const V other = hn::LoadU(d, right + p * plane_ + k * kLanes);
        sum = hn::Add(sum, hn::PopulationCount(hn::Xor(other, word[p])));
      }
      costs.v[k] = sum;
    }
    const auto count = static_cast<std::size_t>(disparities_);
    if (x + 1 >= kBytes && count == kBytes) return costs;
    for (std::size_t k = 0; k < kVectors; ++k) {
      const V index = C::indices(k);
      const auto is_outside = hn::Gt(index, hn::Set(d, static_cast<Byte>(std::min(x, kBytes - 1))));
      const auto is_unwanted = hn::Gt(index, hn::Set(d, static_cast<Byte>(count - 1)));
      costs.v[k] = hn::IfThenElse(is_outside, hn::Set(d, kOutside), costs.v[k]);
      costs.v[k] = hn::Or(costs.v[k], hn::VecFromMask(d, is_unwanted));
    }
    return costs;
  }

  /// A step of a path: the path costs of a pixel from those of the pixel before.
  /// @returns  the minimum of each lane, to be subtracted later.
  static HWY_INLINE V arrive(const C& costs, const C& from, const C& next_to, V slope, V jump,
                             C& to) {
    V min;
    for (std::size_t k = 0; k < kVectors; ++k) {
      const V way = hn::Min(hn::Min(from.v[k], jump), hn::SaturatedAdd(next_to.v[k], slope));
      to.v[k] = hn::SaturatedAdd(costs.v[k], way);
      min = k == 0 ? to.v[k] : hn::Min(min, to.v[k]);
    }
    return min;
  }

  /// The same from costs in memory.
  HWY_INLINE V arrive(const C& costs, const Byte* from, V slope, V jump, C& to) const {
    const D d;
    C same, next_to;
    for (std::size_t k = 0; k < kVectors; ++k) {
      V below = hn::LoadU(d, from + k * kLanes - 1);
      V above = hn::LoadU(d, from + k * kLanes + 1);
      if (k == 0) below = hn::Or(below, before_first_);
      if (k == kVectors - 1) above = hn::Or(above, after_last_);
      same.v[k] = hn::Load(d, from + k * kLanes);
      next_to.v[k] = hn::Min(below, above);
    }
    return arrive(costs, same, next_to, slope, jump, to);
  }

  /// Subtracts the minimum from the costs of a path and adds the costs to `sums`.
  static HWY_INLINE void settle(C& path, V min, C& sums) {
    for (std::size_t k = 0; k < kVectors; ++k) {
      path.v[k] = hn::Sub(path.v[k], min);
      sums.v[k] = hn::SaturatedAdd(sums.v[k], path.v[k]);
    }
  }

  /// Absolute differences of the grey levels of a row to those `step` bytes before.
  void differences(const Byte* grey, std::ptrdiff_t step, Byte* to) const {
    const D d;
    for (std::size_t x = 0; x <= width_; x += kLanes) {
      const V here = hn::LoadU(d, grey + x);
      const V there = hn::LoadU(d, grey + static_cast<std::ptrdiff_t>(x) - step);
      hn::StoreU(hn::Or(hn::SaturatedSub(here, there), hn::SaturatedSub(there, here)), d, to + x);
    }
  }

  V jump(Byte difference) const { return hn::Set(D(), jumps_[difference]); }

  /// Walks along a row to the right and along the row above it to the left. Interleaved because
  /// each step depends on the one before in the same walk.
  template <bool kRight, bool kLeft>
  void sweep(const Row& right, const Row& left) const {
    // Local copies, which the compiler knows are not changed by stores of costs.
    const Sweep copy = *this;
    const Row to_right = right, to_left = left;
    C west, east;
    for (std::size_t k = 0; k < kVectors; ++k) west.v[k] = east.v[k] = hn::Zero(D());
    if (kLeft && copy.is_for_both_) std::fill_n(copy.window_, kBytes, kNever);
    for (std::size_t i = 0; i < copy.width_; ++i) {
      if constexpr (kRight) copy.step_right(to_right, i, west);
      if constexpr (kLeft) {
        const std::size_t x = copy.width_ - 1 - i;
        copy.step_left(to_left, x, east);
        if (x % kGroup == 0) copy.find_winners(to_left, x, std::min(x + kGroup, copy.width_));
      }
    }
  }

  /// The matching costs of a pixel, and the paths to it from the west and from the row above.
  HWY_INLINE void step_right(const Row& row, std::size_t x, C& west) const {
    const D d;
    const std::size_t at = x * kBytes;
    const C costs = matching_costs(x);
    costs.store(row.costs + at);
    C to, north, north_west, north_east, sums;
    for (auto& v : sums.v) v = hn::Zero(d);
    const V min = arrive(costs, west, west.next_to(), slope_, jump(row.along[x]), to);
    settle(to, min_of_lanes(d, min), sums);
    west = to;
    const V min_n = arrive(costs, north_ + at, slope_, jump(down_[x]), north);
    const V min_nw = arrive(costs, north_west_ + at, slope_, jump(down_right_[x]), north_west);
    const V min_ne =
        arrive(costs, north_east_ + at + kBytes, slope_, jump(down_left_[x]), north_east);
    settle(north, min_of_lanes(d, min_n), sums);
    settle(north_west, min_of_lanes(d, min_nw), sums);
    settle(north_east, min_of_lanes(d, min_ne), sums);
    north.store(north_ + at);
    north_west.store(north_west_ + at);
    north_east.store(north_east_ + at);
    sums.store(row.sums + at);
  }

  /// The path to a pixel from the east, which completes its sums.
  HWY_INLINE void step_left(const Row& row, std::size_t x, C& east) const {
    const D d;
    const std::size_t at = x * kBytes;
    C to, sums = C::load(row.sums + at);
    const V min =
        arrive(C::load(row.costs + at), east, east.next_to(), slope_, jump(row.along[x + 1]), to);
    settle(to, min_of_lanes(d, min), sums);
    east = to;
    sums.store(row.sums + at);
  }

  /// The winners of some pixels. Separate from the steps of the paths because pixels are
  /// independent here, and a processor works on several at once.
  HWY_INLINE void find_winners(const Row& row, std::size_t begin, std::size_t end) const {
    auto* winners = reinterpret_cast<Winner*>(winners_);
    for (std::size_t x = begin; x < end; ++x) winners[x] = winner_of(row.sums + x * kBytes);
    if (is_for_both_) find_right_winners(row, begin, end);
  }

  /// The winners of the right image's pixels, whose sums are on the diagonals of those of the left
  /// image: a step to the left moves each right pixel to the disparity less by one, until it is
  /// opposite at 0. Of equal costs the last one wins, which is that of the smallest disparity.
  HWY_INLINE void find_right_winners(const Row& row, std::size_t begin, std::size_t end) const {
    const D d;
    const V never = hn::Set(d, kNever);
    C min = C::load(window_), disparity = C::load(window_ + kBytes);
    for (std::size_t x = end; x-- > begin;) {
      const C costs = C::load(row.sums + x * kBytes);
      for (std::size_t k = 0; k < kVectors; ++k) {
        min.v[k] = hn::Min(min.v[k], costs.v[k]);
        disparity.v[k] =
            hn::IfThenElse(hn::Eq(min.v[k], costs.v[k]), C::indices(k), disparity.v[k]);
      }
      right_disparities_[x] = hn::GetLane(disparity.v[0]);
      for (std::size_t k = 0; k < kVectors; ++k) {
        min.v[k] = min.next_of(k, never);
        disparity.v[k] = disparity.next_of(k, never);
      }
    }
    min.store(window_);
    disparity.store(window_ + kBytes);
  }

  /// The disparity with the minimum cost of a pixel; the smallest if there are several.
  HWY_INLINE Winner winner_of(const Byte* sums) const {
    const D d;
    const V never = hn::Set(d, kNever);
    const C costs = C::load(sums);
    V min = costs.v[0];
    for (std::size_t k = 1; k < kVectors; ++k) min = hn::Min(min, costs.v[k]);
    min = min_of_lanes(d, min);
    std::size_t first = 0;
    for (std::size_t k = kVectors; k-- > 0;) {
      const auto lane = hn::FindFirstTrue(d, hn::Eq(costs.v[k], min));
      if (lane >= 0) first = k * kLanes + static_cast<std::size_t>(lane);
    }
    V other = never;
    const V below = hn::Set(d, static_cast<Byte>(first - 1));
    for (std::size_t k = 0; k < kVectors; ++k) {
      // Unsigned: the winner and its neighbours become 0, 1, 2.
      const auto is_far = hn::Gt(hn::Sub(C::indices(k), below), hn::Set(d, Byte{2}));
      other = hn::Min(other, hn::IfThenElse(is_far, costs.v[k], never));
    }
    const Byte cost = hn::GetLane(min);
    const auto disparity = static_cast<Byte>(first);
    return {disparity, cost, static_cast<Byte>(hn::GetLane(min_of_lanes(d, other)) - cost),
            fraction(sums, disparity)};
  }

  /// The sub-pixel offset of the minimum of a V through the three costs [1/64 px].
  HWY_INLINE std::int8_t fraction(const Byte* sums, int disparity) const {
    if (disparity == 0 || disparity + 1 >= disparities_) return 0;
    const int below = sums[disparity - 1], at = sums[disparity], above = sums[disparity + 1];
    const int rise = std::max(below, above) - at;
    if (rise <= 0 || std::max(below, above) == kNever) return 0;
    return static_cast<std::int8_t>((below - above) * (kSubPixels / 2) / rise);
  }

  /// Writes the disparities that pass the left-right check, in which each right pixel has the
  /// disparity of its best left pixel. Branch-free, since branches are unpredictable here.
  void write_row(std::uint16_t* disparity, Byte* margin) {
    constexpr std::uint16_t kNone = 0xFFFF;
    const auto* winners = reinterpret_cast<const Winner*>(winners_);
    auto* best = reinterpret_cast<std::uint16_t*>(best_);
    std::fill_n(best, width_, kNone);
    for (std::size_t x = 0; x < width_; ++x) {
      const Winner winner = winners[x];
      const bool clear = is_clear(winner, x);
      const auto match = static_cast<std::uint16_t>(winner.cost << 8 | winner.disparity);
      auto& partner = best[clear ? x - winner.disparity : x];
      partner = std::min(partner, clear ? match : kNone);
    }
    for (std::size_t x = 0; x < width_; ++x) {
      const Winner winner = winners[x];
      const bool clear = is_clear(winner, x);
      const int other = best[clear ? x - winner.disparity : x] & 0xFF;
      const bool agrees = clear && std::abs(other - winner.disparity) <= left_right_;
      disparity[x] = static_cast<std::uint16_t>(agrees ? disparity_of(winner) : 0);
      margin[x] = agrees ? winner.margin : Byte{0};
    }
  }

  /// Writes the disparities of the right image's pixels that pass the same check: that of their
  /// partners, which are clear.
  void write_right_row(std::uint16_t* disparity) const {
    const auto* winners = reinterpret_cast<const Winner*>(winners_);
    for (std::size_t x = 0; x < width_; ++x) {
      const std::size_t own = right_disparities_[x], partner = x + own;
      const Winner winner = winners[partner];
      const bool agrees = is_clear(winner, partner) &&
                          std::abs(winner.disparity - static_cast<int>(own)) <= left_right_;
      disparity[x] = static_cast<std::uint16_t>(agrees ? disparity_of(winner) : 0);
    }
  }

  /// In fixed point.
  static int disparity_of(const Winner& winner) {
    return std::max(1, winner.disparity * kSubPixels + winner.fraction);
  }

  [[nodiscard]] bool is_clear(const Winner& winner, std::size_t x) const {
    return winner.margin >= margin_ && winner.disparity <= x && winner.cost != kNever;
  }

  const Stripe& stripe_;
  const SemiGlobal& options_;
  const std::size_t width_, plane_;
  const int disparities_ = options_.disparities, margin_ = options_.margin;
  const int left_right_ = options_.left_right;
  const bool is_for_both_ = stripe_.right_disparity != nullptr;
  const Byte* const jumps_ = options_.penalties.jump.data();
  const V slope_ = hn::Set(D(), options_.penalties.slope);
  const V before_first_ = hn::VecFromMask(D(), hn::FirstN(D(), 1));
  const V after_last_ =
      hn::VecFromMask(D(), hn::Eq(hn::Iota(D(), Byte{0}), hn::Set(D(), Byte{kLanes - 1})));
  Byte* left_ = nullptr;
  Byte* right_ = nullptr;
  Row rows_[2] = {};
  Byte* north_ = nullptr;
  Byte* north_east_ = nullptr;
  Byte* north_west_ = nullptr;
  Byte* winners_ = nullptr;
  Byte* best_ = nullptr;  // of each pixel of the right image, its cost · 256 + its disparity, u16
  // For both eyes: of the right pixels opposite to the disparities of a left one, the minimum so
  // far and its disparity; in the end, the disparity of each right pixel.
  Byte* window_ = nullptr;
  Byte* right_disparities_ = nullptr;
  // Differences of the grey levels of a row to those of the row above.
  Byte* down_ = nullptr;
  Byte* down_right_ = nullptr;
  Byte* down_left_ = nullptr;
};

template <std::size_t kBytes>
void sweep(const Stripe& stripe, const SemiGlobal& options, Scratch& scratch) {
  using D = hn::CappedTag<Byte, kBytes % 64 == 0 ? 64 : 32>;
  Sweep<D, kBytes / hn::MaxLanes(D())>(stripe, options, scratch).run();
}

}  // namespace

void match_rows(const Stripe& stripe, const SemiGlobal& options, Scratch& scratch) {
  const int count = options.disparities;
  if (count <= 32) return sweep<32>(stripe, options, scratch);
  if (count <= 64) return sweep<64>(stripe, options, scratch);
  if (count <= 96) return sweep<96>(stripe, options, scratch);
  if (count <= 128) return sweep<128>(stripe, options, scratch);
  if (count <= 192) return sweep<192>(stripe, options, scratch);
  sweep<256>(stripe, options, scratch);
}

}  // namespace hc::vision::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hc::vision {

HWY_EXPORT(match_rows);

Penalties Penalties::with_jumps(int slope, int max, int min) {
  Penalties penalties;
  penalties.slope = static_cast<std::uint8_t>(slope);
  // The part above the minimum is halved at a difference of 8 grey levels.
  for (int difference = 0; difference < 256; ++difference)
    penalties.jump[static_cast<std::size_t>(difference)] =
        static_cast<std::uint8_t>(min + (max - min) * 8 / (8 + difference));
  return penalties;
}

void match_rows(const Stripe& stripe, const SemiGlobal& options, Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(match_rows)(stripe, options, scratch);
}

std::vector<int> stripes_of(int height) {
  // An even number for pairs of cores; tall, so that warm-up rows are few in comparison.
  constexpr int kRows = 256;
  const int count = 2 * std::max(1, (height + kRows / 2) / kRows);
  std::vector<int> begins;
  for (int i = 0; i <= count; ++i) begins.push_back(height * i / count);
  return begins;
}

}  // namespace hc::vision
#endif  // HWY_ONCE
