// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds boards with markers, which may be partly hidden or outside the image. No messages; plain
// cv::Mat in. A finder belongs to one thread.

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <vision/board.h>
#include <vision/board_layout.h>
#include <vision/marker.h>
#include <opencv2/core.hpp>

namespace hc::vision {

class MarkedBoardFinder {
 public:
  /// @param dictionary  of a ChArUco board, as for ArucoFinder.
  ///
  /// Errors: Invalid (a board that is wrong or has no markers, or more than the dictionary; an
  /// unknown dictionary).
  static Result<MarkedBoardFinder> make(const Board& board, const std::string& dictionary);

  /// Finds the corners that both images show: at least eight, over a tenth of the board.
  ///
  /// A corner counts if a marker beside it is seen, and itself. Markers that do not fit the others
  /// are ignored; if they are more than a third of those of the board, it is another board.
  ///
  /// @param left, right  (H, W) or (H, W, 3) u8, red, green, blue.
  /// Cost: at 800×600 20 ms for a ChArUco board, 60 ms for an AprilGrid; at most 0.3 s for larger
  ///     images.
  [[nodiscard]] std::optional<BoardView> find(const cv::Mat& left, const cv::Mat& right) const;

 private:
  using FindMarkers = std::function<std::vector<Marker>(const cv::Mat& grey)>;
  using Layout = std::vector<BoardMarker>;
  using Corners = std::map<std::size_t, cv::Point2f>;  // by number
  struct Seen {
    cv::Mat grey;
    std::vector<Marker> markers;  ///< of the board by their ids
  };

  MarkedBoardFinder(const Board& board, FindMarkers find, std::vector<Layout> layouts)
      : board_(board), find_markers_(std::move(find)), layouts_(std::move(layouts)) {}
  [[nodiscard]] Seen look(const cv::Mat& image) const;
  /// The corners beside the markers.
  [[nodiscard]] Corners corners_of(const Seen& seen, const Layout& layout) const;
  [[nodiscard]] bool is_enough(const BoardView& view) const;

  Board board_;
  FindMarkers find_markers_;
  std::vector<Layout> layouts_;  // in which the board may have been drawn
};

}  // namespace hc::vision
