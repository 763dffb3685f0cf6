// SPDX-License-Identifier: Apache-2.0
// faces [--found] [LIST]: scores the recognition of faces, as Markdown: faces found in photographs
// of packages (bench/photographs.txt), which are never copied, and in simulated rooms
// without people; how sure it is whose they are, in the photographs and of the simulated persons
// from many sides. --found prints the faces that are found.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <nets/weights.h>
#include <people/box.h>
#include <people/embedding.h>
#include <people/face_search.h>
#include <people/gallery.h>
#include <room/ball.h>
#include <room/chance.h>
#include <room/people.h>
#include <room/scenery.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "head_sees.h"

namespace {

using namespace std::chrono_literals;
using bench::must;
using hc::people::Embedding, hc::people::Identifier;
using hc::people::Face, hc::people::FaceFinder, hc::people::FaceSearch;

constexpr float kLeastWidth = 40;  // of a face that is to be found [px]
constexpr auto kSame = static_cast<float>(hc::people::kSamePerson);

/// A face that somebody has seen in a photograph.
struct Label {
  cv::Point2f middle;  // [px]
  float width = 0;     // [px]
  std::string person;  // "-", or "profile": not compared with others
};

struct Photograph {
  std::string path;
  int turns = 0;  // by 90° clockwise, after which it is upright
  std::optional<cv::Rect> part;
  std::vector<Label> labels;
};

/// Lines "photograph PATH", and for the last one "turn DEGREES", "part X Y WIDTH HEIGHT" and "face
/// X Y WIDTH PERSON".
std::vector<Photograph> read_list(const std::string& path) {
  std::ifstream file(path);
  if (!file) bench::fail(path + " cannot be read");
  std::vector<Photograph> all;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what;
    if (!(words >> what) || what[0] == '#') continue;
    if (what == "photograph") {
      words >> all.emplace_back().path;
    } else if (!all.empty() && what == "turn") {
      int degrees = 0;
      words >> degrees;
      all.back().turns = degrees / 90;
    } else if (!all.empty() && what == "part") {
      cv::Rect part;
      words >> part.x >> part.y >> part.width >> part.height;
      all.back().part = part;
    } else if (!all.empty() && what == "face") {
      Label label;
      words >> label.middle.x >> label.middle.y >> label.width >> label.person;
      all.back().labels.push_back(label);
    } else {
      bench::fail(path + ": not a line of it: " + line);
    }
    if (!words) bench::fail(path + ": a line is too short: " + line);
  }
  return all;
}

/// A photograph as an image of the head's eyes, RGB, 800 × 600 at most; empty where it is missing.
cv::Mat load(const Photograph& photograph) {
  cv::Mat bgr = cv::imread(photograph.path, cv::IMREAD_COLOR), image;
  if (bgr.empty()) return bgr;
  for (int i = 0; i < photograph.turns; ++i) cv::rotate(bgr, bgr, cv::ROTATE_90_CLOCKWISE);
  if (photograph.part) bgr = bgr(*photograph.part & cv::Rect({}, bgr.size()));
  const double scale = std::min({1.0, 800.0 / bgr.cols, 600.0 / bgr.rows});
  cv::resize(bgr, bgr, {}, scale, scale, cv::INTER_AREA);
  cv::cvtColor(bgr, image, cv::COLOR_BGR2RGB);
  return image;
}

/// Finds faces, and describes them.
class Sight {
 public:
  std::vector<Face> find(const cv::Mat& image) {
    now_ += 1h;  // so that all parts are searched, and no face is followed
    std::vector<Face> faces;
    for (const auto& track : search_.look(now_, image)) faces.push_back(track.face);
    return faces;
  }
  std::vector<Face> look_around(const cv::Mat& image, const Face& face, float least) {
    return search_.look_around(image, face.box, least);
  }
  Embedding describe(const cv::Mat& image, const Face& face) {
    return identifier_.describe(image, face).value();
  }
  /// The same face, seen in crops that are up to 6 % of its width aside, as one that is followed.
  std::vector<Embedding> describe_in_crops(const cv::Mat& image, const Face& face) {
    constexpr int kCrops = 6;
    std::vector<Embedding> all;
    for (int i = 0; i < kCrops; ++i) {
      cv::Rect2f box = face.box;
      for (float* place : {&box.x, &box.y})
        *place += static_cast<float>(0.12 * (chance_.next() - 0.5)) * face.box.width;
      for (const Face& seen : search_.look_around(image, box))
        if (hc::people::overlap(seen.box, face.box) > 0.3F) {
          all.push_back(describe(image, seen));
          break;
        }
    }
    return all;
  }

 private:
  FaceSearch search_ = must(FaceSearch::read());
  Identifier identifier_ = must(Identifier::make(
      must(hc::nets::Network::read(hc::nets::weights_path("face_recognition.json")))));
  hc::Time now_{1'700'000'000s};
  hc::room::Chance chance_{1};
};

cv::Point2f middle_of(const Face& face) {
  return (face.box.tl() + face.box.br()) / 2;
}

/// The face that was found around a place, if any.
const Face* face_at(const std::vector<Face>& faces, const cv::Point2f& middle, float width) {
  const auto found = std::ranges::find_if(
      faces, [&](const Face& face) { return cv::norm(middle_of(face) - middle) < width / 2; });
  return found == faces.end() ? nullptr : &*found;
}

/// A face in an image, described.
struct View {
  std::string person;
  std::string image;  // two views of one person are compared only if their images differ
  Embedding embedding = {};
};

/// Of the faces at least kLeastWidth wide, and of the others.
struct Found {
  int wide = 0, all_wide = 0, small = 0, all_small = 0, wrong = 0, images = 0;
};

void look_at(Sight& sight, const Photograph& photograph, bool prints, Found& found,
             std::vector<View>& views) {
  const cv::Mat image = load(photograph);
  if (image.empty()) {
    std::fprintf(stderr, "%s is missing: is its package installed?\n", photograph.path.c_str());
    return;
  }
  ++found.images;
  const auto faces = sight.find(image);
  if (prints) {
    std::printf("%s\n", photograph.path.c_str());
    for (const Face& face : faces)
      std::printf("  face %.0f %.0f %.0f, score %.2f\n", double(middle_of(face).x),
                  double(middle_of(face).y), double(face.box.width), double(face.score));
  }
  std::size_t known = 0;
  for (const auto& label : photograph.labels) {
    const Face* face = face_at(faces, label.middle, label.width);
    const bool is_wide = label.width >= kLeastWidth, is_found = face != nullptr;
    (is_wide ? found.all_wide : found.all_small) += 1;
    (is_wide ? found.wide : found.small) += is_found;
    known += is_found;
    if (prints && !is_found)
      std::printf("  %s at %.0f %.0f was not found\n", label.person.c_str(), double(label.middle.x),
                  double(label.middle.y));
    if (is_found && is_wide && label.person != "-" && label.person != "profile")
      for (const auto& embedding : sight.describe_in_crops(image, *face))
        views.push_back({label.person, photograph.path, embedding});
  }
  found.wrong += static_cast<int>(faces.size() - known);
}

/// Views of the simulated persons, from several distances and sides, in several lights.
std::vector<View> simulated_views(Sight& sight, int& missed) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const auto renderer = bench::make_renderer();
  hc::room::World world(*renderer, 5, "", hc::room::kMostPeople);
  hc::room::People people({hc::room::kMostPeople, "still", 5});
  std::vector<View> views;
  std::uint64_t number = 0;
  for (auto person : people.at(0)) {
    const Vector3d at = person.T_world_face.translation();
    for (const double distance : {0.9, 1.4, 2.0, 2.6})
      for (const double yaw : {-40, -25, -10, 0, 10, 25, 40})
        for (const float exposure : {0.5F, 1.0F, 1.5F}) {
          person.T_world_face.linear() =
              AngleAxisd(M_PI + yaw * M_PI / 180, Vector3d::UnitZ()).toRotationMatrix();
          const auto T_world_eye = hc::room::hang(at - Vector3d(distance, 0, 0), 0);
          auto light = world.light();
          light.exposure = exposure;
          cv::Mat image;
          must(renderer->draw(world.items({0, 0, -10}, {person}), bench::kCamera, T_world_eye,
                              light, image));
          hc::room::Sensor(number).apply(image, 0, 2, number);
          ++number;
          const auto faces = sight.find(image);
          const auto width = static_cast<float>(bench::kCamera.fx * 0.15 / distance);
          const Face* face = face_at(faces, cv::Point2f(399.5F, 299.5F), width);
          if (face == nullptr) {
            ++missed;
            continue;
          }
          views.push_back({std::to_string(person.number), std::to_string(number),
                           sight.describe(image, *face)});
        }
  }
  return views;
}

/// Faces in images of rooms without people.
struct FalseFaces {
  int images = 0, found = 0;
  int wide = 0;  // possible ones by the large network
  // Greatest scores by the small one, where the large one takes a face for likely, and elsewhere.
  float most_likely = 0, most_elsewhere = 0;
};

FalseFaces find_false_faces(Sight& sight, std::uint64_t rooms, int images) {
  auto wide = must(FaceFinder::read_wide());
  const auto renderer = bench::make_renderer();
  FalseFaces all;
  for (std::uint64_t seed = 1; seed <= rooms; ++seed) {
    hc::room::World world(*renderer, seed, "", 0);
    hc::room::Ball ball({.seed = seed});
    hc::room::Chance chance(seed);
    for (int i = 0; i < images; ++i, ++all.images) {
      const auto at = ball.at(0.37 * i).position;
      // The ball is near the middle.
      const bench::Gaze gaze{.pan = std::atan2(at.y(), at.x()) + 0.6 * (chance.next() - 0.5),
                             .tilt = 0.3 + 0.5 * (chance.next() - 0.5),
                             .image = static_cast<std::uint64_t>(i)};
      const cv::Mat image = bench::look(*renderer, world, at, gaze)[0].image;
      all.found += static_cast<int>(sight.find(image).size());
      for (const cv::Rect& part : hc::people::parts_of(image.size(), wide.size()))
        for (const Face& face : wide.find(image, part, FaceSearch::kPossible)) {
          ++all.wide;
          for (const Face& other : sight.look_around(image, face, 0.1F))
            if (hc::people::overlap(other.box, face.box) > 0.3F) {
              float& most = face.score < FaceSearch::kLikely ? all.most_elsewhere : all.most_likely;
              most = std::max(most, other.score);
            }
        }
    }
  }
  return all;
}

/// Distances of pairs of one person, and of two.
struct Pairs {
  std::vector<float> same, other;
};

Pairs pairs_of(const std::vector<View>& views) {
  Pairs pairs;
  for (std::size_t a = 0; a < views.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const float apart = hc::people::distance(views[a].embedding, views[b].embedding);
      if (views[a].person != views[b].person)
        pairs.other.push_back(apart);
      else if (views[a].image != views[b].image)
        pairs.same.push_back(apart);
    }
  return pairs;
}

/// Each view, and the mean of all others of a person, as `faces` compares them.
Pairs pairs_with_known(const std::vector<View>& views) {
  std::map<std::string, std::vector<std::size_t>> of_person;
  for (std::size_t i = 0; i < views.size(); ++i) of_person[views[i].person].push_back(i);
  Pairs pairs;
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const auto& [person, all] : of_person) {
      std::vector<Embedding> others;
      for (const std::size_t k : all)
        if (person != views[i].person || views[k].image != views[i].image)
          others.push_back(views[k].embedding);
      if (others.empty()) continue;
      const float apart = hc::people::distance(views[i].embedding, hc::people::mean(others));
      (person == views[i].person ? pairs.same : pairs.other).push_back(apart);
    }
  return pairs;
}

double share_below(const std::vector<float>& sorted, float limit) {
  const auto end = std::ranges::lower_bound(sorted, limit);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

void print_errors(const char* what, Pairs pairs) {
  if (pairs.same.empty() || pairs.other.empty())
    return std::printf("| %s | none | | | | |\n", what), void();
  std::ranges::sort(pairs.same);
  std::ranges::sort(pairs.other);
  // Where as many of one person are taken for two as of two for one.
  float limit = 0;
  while (share_below(pairs.other, limit) < 1 - share_below(pairs.same, limit)) limit += 0.001F;
  const double equal = (share_below(pairs.other, limit) + 1 - share_below(pairs.same, limit)) / 2;
  std::printf("| %s | %zu | %zu | %.2f %% at %.2f | %.2f %% | %.2f %% |\n", what, pairs.same.size(),
              pairs.other.size(), 100 * equal, double(limit), 100 * share_below(pairs.other, kSame),
              100 * (1 - share_below(pairs.same, kSame)));
}

}  // namespace

int main(int argc, char** argv) {
  bool prints = false;
  std::string list = HC_SOURCE_DIR "/bench/photographs.txt";
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--found")
      prints = true;
    else
      list = argv[i];
  }
  cv::setNumThreads(1);
  Sight sight;
  Found found;
  std::vector<View> photographed;
  for (const auto& photograph : read_list(list))
    look_at(sight, photograph, prints, found, photographed);
  std::printf(
      "%d photographs: of %d faces at least %.0f px wide %d were found, of %d smaller ones "
      "%d; %d others were found.\n\n",
      found.images, found.all_wide, double(kLeastWidth), found.wide, found.all_small, found.small,
      found.wrong);
  const auto none = find_false_faces(sight, 12, 100);
  std::printf(
      "%d images of rooms without people: %d faces were found. The large network takes %d places "
      "for possible faces, to which the small one gives %.2f at most where they are likely, and "
      "%.2f elsewhere.\n\n",
      none.images, none.found, none.wide, double(none.most_likely), double(none.most_elsewhere));
  int missed = 0;
  const auto simulated = simulated_views(sight, missed);
  std::printf("%zu views of the simulated persons, and %d in which none was found.\n\n",
              simulated.size(), missed);
  std::printf(
      "| pairs | of one person | of two | equal error | false accepts at %.2f | false "
      "rejects |\n|---|---:|---:|---:|---:|---:|\n",
      double(kSame));
  print_errors("photographs, view and view", pairs_of(photographed));
  print_errors("photographs, view and mean of others", pairs_with_known(photographed));
  print_errors("simulated, view and view", pairs_of(simulated));
  print_errors("simulated, view and mean of others", pairs_with_known(simulated));
}
