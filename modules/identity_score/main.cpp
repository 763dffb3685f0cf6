// SPDX-License-Identifier: Apache-2.0
// Scores whether faces keep their names and tracks, against the ground truth of a simulation; names
// them for that, as a person at the page does.
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <people/face_table.h>
#include <room/truth_rows.h>
#include <transports/all.h>

#include "score.h"

namespace {

using Rows = hc::MatrixView<const double>;

std::vector<TruePerson> people_of(const Rows& rows) {
  std::vector<TruePerson> people;
  for (std::size_t i = 0; i < rows.height(); ++i) {
    const auto row = hc::read_row<hc::room::PersonColumns, hc::room::PersonRow>(rows.row(i));
    if (row)
      people.push_back({row->person, row->pixel.x(), row->pixel.y(), row->width, row->visible});
  }
  return people;
}

std::vector<SeenFace> faces_of(const Rows& rows) {
  std::vector<SeenFace> faces;
  for (std::size_t i = 0; i < rows.height(); ++i) {
    const auto face = hc::people::face_in(rows.row(i));
    if (!face) continue;
    const cv::Point2f eyes = face->face.between_eyes();
    faces.push_back({eyes.x, eyes.y, face->track, face->person});
  }
  return faces;
}

class Program {
 public:
  explicit Program(hc::Module& module) : module_(module) {
    module.on_start([this] { silence_.restart(hc::duration(*timeout_)); });
    module.on(truth_, [this](const auto& message) { see(message); });
    module.on(faces_, [this](const auto& message) { take_faces(message); });
    module.on(names_, [this](const auto& message) {
      known_ = persons_named(message.text());
      score_.set_names(known_);
    });
    module.every(std::chrono::seconds(1), [this] { name_one(); });
  }

 private:
  using Table = hc::MessageOf<hc::TableKind<double>>;

  void see(const Table& message) {
    silence_.restart(hc::duration(*timeout_));
    const auto time = message.header.time;
    recent_.emplace_back(time, people_of(message.matrix()));
    constexpr std::size_t kRecent = 64;
    if (recent_.size() > kRecent) recent_.pop_front();
    if (!begin_) begin_ = time;
    if (time - *begin_ < hc::duration(*duration_)) return;
    if (*names_people_) throw hc::ModuleError("not everybody could be named within duration");
    result_.send(score_.numbers());
    module_.log(hc::format("{} in {:.0f} s", score_.text(), *duration_), hc::Level::Result);
    module_.stop();
  }

  void take_faces(const Table& message) {
    for (const auto& [time, people] : recent_) {
      if (time != message.header.time) continue;
      const auto faces = faces_of(message.matrix());
      score_.look(people, faces);
      nameless_.clear();
      for (const auto& person : people)
        if (!is_known(person.number)) nameless_[person.number] = 0;
      for (const auto& face : faces)
        if (const auto person = person_at(people, face); person && !is_known(*person))
          nameless_[*person] = face.track;
    }
  }

  /// Names one of those who have no name yet; ends when all have one.
  void name_one() {
    if (!*names_people_ || recent_.empty()) return;
    for (const auto& [person, track] : nameless_)
      if (track != 0) return name_.send(hc::format("{} {}", track, person), module_.now());
    if (nameless_.empty() && !known_.empty()) module_.stop();
  }

  [[nodiscard]] bool is_known(int person) const {
    for (const auto& [known, named] : known_)
      if (named == person) return true;
    return false;
  }

  hc::Module& module_;
  hc::Input<hc::TableKind<double>> truth_ =
      module_.input("people", hc::table().of(0, hc::room::kPersonColumns),
                    "truth: of the simulator", {.keep = 64});
  hc::Input<hc::TableKind<double>> faces_ = module_.input(
      "faces", hc::table().of(0, hc::people::kFaceColumns), "faces of module faces", {.keep = 64});
  hc::Input<hc::StringKind> names_ = module_.input(
      "names", hc::string(), "names of module faces: that of a person is the simulator's number");
  hc::Output<hc::StringKind> name_ =
      module_.output("name", hc::string(), "for faces: \"TRACK NAME\"");
  hc::Output<hc::TableKind<double>> result_ = module_.output(
      "score", hc::table().of(1, 5), "at the end",
      {.columns = {"looks", "named", "wrong names", "swapped names", "swapped tracks"}});
  hc::Parameter<bool> names_people_ =
      module_.parameter("names_people", false, "",
                        "names everybody instead of scoring, and ends then", {.fixed = true});
  hc::Parameter<double> duration_ =
      module_.parameter("duration", 20.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  hc::Parameter<double> timeout_ =
      module_.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});

  IdentityScore score_;
  std::map<int, int> known_;     // person of each known number
  std::map<int, int> nameless_;  // persons in the last image, and their tracks, 0: not seen
  // The people of recent images, since faces are found later.
  std::deque<std::pair<hc::Time, std::vector<TruePerson>>> recent_;
  std::optional<hc::Time> begin_;
  hc::Timeout silence_ = module_.after(std::chrono::seconds(60),
                                       [] { throw hc::ModuleError("no image within timeout"); });
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"identity_score",
                    "Compares the names and tracks of faces with the people in a simulated room."};
  Program program{module};
  return module.run(argc, argv);
}
