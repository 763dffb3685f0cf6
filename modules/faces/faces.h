// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds the faces in the images of one eye or both, and knows people by name.

#include <optional>
#include <string>

#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <people/embedding.h>
#include <people/face_distances.h>
#include <people/face_search.h>
#include <people/face_table.h>
#include <people/track_views.h>
#include <vision/module_cameras.h>
#include <vision/right_images.h>

#include "folder.h"

class Faces {
 public:
  /// @param module  must outlive it.
  explicit Faces(hc::Module& module);

 private:
  /// Made when the parameters are known.
  struct Networks {
    hc::people::FaceSearch search;
    hc::people::Identifier identifier;
  };
  /// A name that somebody gave to a track, until it is learned or refused.
  struct NameRequest {
    int track;
    std::string name;
    hc::MonotonicTime until;
  };
  static constexpr std::chrono::milliseconds kRequestLife{10'000};
  static constexpr std::size_t kMostRequests = 16;

  void start();
  /// Looks at a left image, once it is known how the head was turned then.
  void look(const hc::Message& message);
  /// Measures distances in the right image of the last left one.
  void look_right(const hc::Message& message);
  /// How pixels have moved since the last image by the turn of the head.
  cv::Matx33f turn_to(const hc::Header& image);
  /// Describes one of the faces, if it is due.
  void describe(hc::Time time, const cv::Mat& image, const std::vector<hc::people::Track>& seen);
  void send(const hc::Header& image, const std::vector<hc::people::Track>& seen);
  /// Takes a request for a name, which waits until it is certain whose face the track shows.
  void take_request(std::string_view text);
  void answer_requests();
  void refuse(const NameRequest& request, const std::string& why);
  /// @returns whether the request has been answered; otherwise it waits.
  bool learn(const NameRequest& request);
  /// Why a track's person does not get this name; nothing: they do.
  [[nodiscard]] std::optional<std::string> reason_against(const NameRequest& request) const;
  void read_folder();
  /// Forgets everybody where no image has come for as long as a track lasts.
  void forget();
  /// A person's number; 0: unknown.
  [[nodiscard]] int person(int track) const;
  /// The middle between the eyes, in the head's frame [m].
  [[nodiscard]] Eigen::Vector3d place(const hc::Header& image, const hc::people::Track& track);
  [[nodiscard]] static hc::people::FacePair pair_of(const hc::vision::PairIntrinsics& cameras) {
    return {static_cast<float>(cameras.fx), static_cast<float>(cameras.baseline)};
  }

  hc::Module& module_;
  hc::Input<hc::ImageKind> left_ = module_.input(
      "left", hc::image(), "left image, best rectified: faces are found in it", {.keep = 1});
  hc::Input<hc::ImageKind> right_ = module_.input(
      "right", hc::image(), "right image of the rectified pair, for distances", {.keep = 1});
  hc::Input<hc::TransformationKind<double>> cameras_ =
      module_.input("cameras", hc::transformation(),
                    "mounting of the eyes on the head, from rectify; until then from the frames");
  hc::Input<hc::StringKind> name_ =
      module_.input("name", hc::string(), "\"TRACK NAME\": learns the person of that track");
  hc::Output<hc::TableKind<double>> faces_ = module_.output(
      "faces", hc::table(),
      "a row for each face of the left image, in its coordinate system; person 0 is unknown; "
      "x y z: the middle between the eyes, in the head's frame",
      {.columns = hc::people::face_columns()});
  hc::Output<hc::PositionKind<double>> target_ =
      module_.output("target", hc::position().in(hc::Coord::kHead),
                     "the nearest face: the middle between its eyes; nothing while there is none");
  hc::Output<hc::StringKind> names_ = module_.output(
      "names", hc::string(), "a line \"PERSON NAME\" for each known person, once a second");
  hc::Parameter<std::string> people_ =
      module_.parameter("people", "", "",
                        "folder of known people, a file for each (doc/people.md); "
                        "made when the first is learned",
                        {.fixed = true});
  hc::Parameter<double> same_ = module_.parameter(
      "same", hc::people::kSamePerson, "",
      "maximum distance of a face from the person it is taken for", {.min = 0, .max = 2});
  hc::Parameter<double> score_ = module_.parameter(
      "score", 0.5, "",
      "minimum score of a face; of a new one at least 0.65, or 0.8 where one is less likely",
      {.min = 0, .max = 1});
  hc::ModuleFrames frames_{module_};
  hc::vision::ModulePair intrinsics_{module_, frames_, "distances have no true scale"};

  hc::vision::RectifiedMount mount_;
  std::optional<Networks> networks_;
  std::optional<Folder> folder_;
  hc::people::TrackViews views_;
  hc::people::FaceDistances distances_;
  std::optional<hc::MonotonicTime> looked_;  // when it last looked at an image
  hc::vision::RightImages rights_;
  hc::Time last_;                                  // left image
  std::optional<Eigen::Matrix3d> R_robot_camera_;  // then
  std::vector<hc::people::Track> seen_;            // then
  std::vector<NameRequest> requests_;              // not answered yet
};
