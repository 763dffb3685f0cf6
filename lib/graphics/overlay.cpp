// SPDX-License-Identifier: Apache-2.0
#include <graphics/overlay.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

namespace hc::graphics {
namespace {

struct Group {
  cv::Rect part;
  std::vector<Item> items;
};

/// Groups bodies that may hide one another, to draw them together.
std::vector<Group> group(std::span<const Body> bodies, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_world_camera) {
  std::vector<Group> groups;
  for (const auto& body : bodies) {
    Group all{part_of(body, camera, T_world_camera), body.items()};
    if (all.part.empty()) continue;
    // A group that grows may reach others, so start over.
    for (auto other = groups.begin(); other != groups.end();) {
      if ((other->part & all.part).empty()) {
        ++other;
        continue;
      }
      all.part |= other->part;
      all.items.insert(all.items.end(), other->items.begin(), other->items.end());
      groups.erase(other);
      other = groups.begin();
    }
    groups.push_back(std::move(all));
  }
  return groups;
}

/// Visibility of the drawn pixels of a row, 0 … 255; other pixels take that of the last drawn one,
/// so that edges can be refined on both sides.
void see(const float* depth, const float* nearness, float scale, int width, std::uint8_t* seen) {
  float drawn = 0;  // nearness
  for (int x = 0; x < width; ++x) {
    if (depth[x] > 0) drawn = scale / depth[x];
    const float before = drawn == 0 ? 0 : nearness[x] - drawn - Overlay::kMargin;
    seen[x] =
        static_cast<std::uint8_t>(255 * (1 - std::clamp(before / Overlay::kSoft, 0.0F, 1.0F)));
  }
}

constexpr int kNear = 6;              // distance from an edge to refine [px]
constexpr int kReach = 8, kStep = 4;  // of the window and its samples [px]

/// Similarity of two colours, by the sum of their channels' differences.
std::array<float, 3 * 255 + 1> make_likeness() {
  constexpr float kNoise = 20, kLeast = 1e-4F;
  std::array<float, 3 * 255 + 1> all;
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = std::exp(-static_cast<float>(i) / kNoise) + kLeast;
  return all;
}

/// Visibility of a pixel near an edge: the mean over near pixels of similar colour.
std::uint8_t seen_as_alike(const cv::Mat& image, const cv::Mat& seen, int y, int x) {
  static const auto kLikeness = make_likeness();
  const auto& here = image.at<cv::Vec3b>(y, x);
  float sum = 0, weights = 0;
  for (int v = y - kReach; v <= y + kReach; v += kStep) {
    if (v < 0 || v >= seen.rows) continue;
    const auto* pixels = image.ptr<cv::Vec3b>(v);
    const std::uint8_t* shares = seen.ptr(v);
    for (int u = std::max(x - kReach, x % kStep); u <= std::min(x + kReach, seen.cols - 1);
         u += kStep) {
      const auto& there = pixels[u];
      const int difference = std::abs(here[0] - there[0]) + std::abs(here[1] - there[1]) +
                             std::abs(here[2] - there[2]);
      const float weight = kLikeness[static_cast<std::size_t>(difference)];
      weights += weight;
      sum += weight * static_cast<float>(shares[u]);
    }
  }
  constexpr float kContrast = 3, kMiddle = 127.5F;  // so that the mean does not soften the edge
  return cv::saturate_cast<std::uint8_t>(kMiddle + kContrast * (sum / weights - kMiddle));
}

/// Aligns the edges of the visibility with edges of the image.
///
/// Source: Kopf et al., Joint Bilateral Upsampling, 2007.
///
/// @param rgba  pixels that are not drawn are skipped.
void refine(const cv::Mat& image, const cv::Mat& rgba, const cv::Mat& seen, cv::Mat& refined) {
  seen.copyTo(refined);
  double least = 0;
  cv::minMaxLoc(seen, &least);
  if (least == 255) return;  // nothing is hidden
  cv::Mat lowest, highest;
  const cv::Mat window = cv::Mat::ones(2 * kNear + 1, 2 * kNear + 1, CV_8U);
  cv::erode(seen, lowest, window);
  cv::dilate(seen, highest, window);
  cv::parallel_for_({0, seen.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const std::uint8_t *low = lowest.ptr(y), *high = highest.ptr(y);
      const auto* drawn = rgba.ptr<cv::Vec4b>(y);
      for (int x = 0; x < seen.cols; ++x)
        if (drawn[x][3] != 0 && low[x] != high[x])
          refined.at<std::uint8_t>(y, x) = seen_as_alike(image, seen, y, x);
    }
  });
}

void cover(const cv::Vec4b* rgba, int width, std::uint8_t* opacity) {
  for (int x = 0; x < width; ++x) opacity[x] &= rgba[x][3];  // 0 or 255
}

void blend(const cv::Vec4b* rgba, const std::uint8_t* opacity, int width, cv::Vec3b* image) {
  for (int x = 0; x < width; ++x) {
    const int share = opacity[x];
    if (share == 0) continue;
    const auto& drawn = rgba[x];
    if (share == 255)
      image[x] = {drawn[0], drawn[1], drawn[2]};
    else
      for (int channel = 0; channel < 3; ++channel)
        image[x][channel] = static_cast<std::uint8_t>(
            (drawn[channel] * share + image[x][channel] * (255 - share) + 127) / 255);
  }
}

}  // namespace

void Body::set_size(double size) {
  const double longest = bounds.sizes().maxCoeff();
  if (longest > 0) scale = size / longest;
}

std::vector<Item> Body::items() const {
  std::vector<Item> all;
  for (const auto surface : surfaces)
    all.push_back({surface, T_world_body.cast<float>(), static_cast<float>(scale)});
  return all;
}

std::array<Eigen::Vector3d, 8> Body::corners() const {
  std::array<Eigen::Vector3d, 8> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    all[i] = T_world_body * (scale * bounds.corner(corner));
  }
  return all;
}

Body make_body(Renderer& renderer, const std::vector<Part>& parts) {
  Body body;
  for (const auto& part : parts) {
    for (const auto& vertex : part.mesh.vertices)
      body.bounds.extend(vertex.position.cast<double>());
    body.surfaces.push_back(renderer.add(part.mesh, part.texture));
  }
  return body;
}

cv::Rect part_of(const Body& body, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera) {
  const cv::Rect whole(0, 0, camera.width, camera.height);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  Eigen::AlignedBox2d seen;
  int behind = 0;
  for (const auto& corner : body.corners()) {
    const Eigen::Vector3d p = T_camera_world * corner;
    if (p.z() < camera.near)
      ++behind;
    else
      seen.extend(camera.project(p));
  }
  if (behind == 8) return {};
  if (behind > 0) return whole;
  // One pixel more, limited so that the conversion to int cannot overflow.
  const Eigen::Vector2d most(camera.width, camera.height);
  const Eigen::Vector2d from = (seen.min().array() - 1).floor().max(0.0).min(most.array());
  const Eigen::Vector2d to = (seen.max().array() + 2).ceil().max(0.0).min(most.array());
  return whole & cv::Rect(cv::Point(static_cast<int>(from.x()), static_cast<int>(from.y())),
                          cv::Point(static_cast<int>(to.x()), static_cast<int>(to.y())));
}

Status Overlay::draw(std::span<const Body> bodies, const View& view, cv::Mat& image,
                     cv::Mat* mask) {
  for (const auto& each : group(bodies, view.camera, view.T_world_camera))
    HC_TRY(draw_part(each.items, view, each.part, image, mask));
  return {};
}

Status Overlay::draw_part(const std::vector<Item>& items, const View& view, const cv::Rect& part,
                          cv::Mat& image, cv::Mat* mask) {
  const auto pixels = static_cast<std::size_t>(part.area());
  rgba_.resize(std::max(rgba_.size(), 4 * pixels));
  depth_.resize(std::max(depth_.size(), pixels));
  cv::Mat rgba(part.size(), CV_8UC4, rgba_.data()), depth(part.size(), CV_32F, depth_.data());
  if (auto drawn = renderer_.draw_part(items, view.camera, part, view.T_world_camera, view.light,
                                       rgba, depth);
      !drawn)
    return drawn;
  seen_.create(part.size(), CV_8U);
  if (view.nearness) {
    view.nearness(part, nearness_);
    cv::parallel_for_({0, part.height}, [&](const cv::Range& rows) {
      for (int y = rows.start; y < rows.end; ++y)
        see(depth.ptr<float>(y), nearness_.ptr<float>(y), static_cast<float>(view.scale),
            part.width, seen_.ptr(y));
    });
  } else {
    seen_ = 255;
  }
  refine(image(part), rgba, seen_, opacity_);
  for (int y = 0; y < part.height; ++y) cover(rgba.ptr<cv::Vec4b>(y), part.width, opacity_.ptr(y));
  // Softens the rim of the bodies, too; only inwards, since there is no colour outside.
  cv::blur(opacity_, seen_, {3, 3}, {-1, -1}, cv::BORDER_REPLICATE);
  cv::parallel_for_({0, part.height}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      cover(rgba.ptr<cv::Vec4b>(y), part.width, seen_.ptr(y));
      blend(rgba.ptr<cv::Vec4b>(y), seen_.ptr(y), part.width,
            image.ptr<cv::Vec3b>(part.y + y) + part.x);
    }
  });
  if (mask != nullptr) seen_.copyTo((*mask)(part));
  return {};
}

}  // namespace hc::graphics
