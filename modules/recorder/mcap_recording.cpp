// SPDX-License-Identifier: Apache-2.0
#include "mcap_recording.h"

#include <cstdlib>
#include <utility>

#include "graph_metadata.h"

namespace {

class McapRecording : public Recording {
 public:
  McapRecording(hc::Module& module, McapOptions options, std::vector<std::string> streams,
                std::unique_ptr<hc::mcap::Recorder> recorder)
      : module_(module),
        options_(std::move(options)),
        streams_(std::move(streams)),
        recorder_(std::move(recorder)) {
    for (const auto& name : streams_) recorder_->add_stream(name);
  }

  hc::Status record(std::size_t stream, const hc::Message& message) override {
    auto recorded = recorder_->record(stream, message, module_.now());
    if (!recorded && recorded.error().code == hc::Code::TooLarge) {  // too many streams
      module_.log_once(streams_[stream], streams_[stream] + " dropped: " + recorded.error().detail);
      recorded = {};
    }
    if (options_.last.count() > 0 && streams_[stream] == options_.when) save_when_set(message);
    return recorded;
  }

  hc::Status poll() override {
    if (metadata_ != nullptr) metadata_->record(*recorder_, module_.now());
    return recorder_->poll();
  }

  [[nodiscard]] int descriptor() const override {
    return metadata_ != nullptr ? metadata_->descriptor() : -1;
  }

  void save() override {
    auto saved = recorder_->save();
    module_.log(saved ? "saved " + *saved : "error: not saved: " + saved.error().detail);
  }

  hc::Status close() override { return recorder_->close(); }

  [[nodiscard]] const std::string& place() const override { return recorder_->file(); }
  [[nodiscard]] std::uint64_t messages() const override { return recorder_->messages(); }
  [[nodiscard]] std::uint64_t lost() const override { return recorder_->lost(); }

 private:
  void save_when_set(const hc::Message& message) {
    const bool is_set = message.plain() && !message.elements.empty() &&
                        hc::visit_scalar(message.header.info.scalar, [&](auto zero) {
                          return message.view<decltype(zero)>()->numbers().front() != zero;
                        });
    if (is_set && !was_set_) save();
    was_set_ = is_set;
  }

  hc::Module& module_;
  const McapOptions options_;
  const std::vector<std::string> streams_;
  std::unique_ptr<hc::mcap::Recorder> recorder_;
  std::unique_ptr<GraphMetadata> metadata_ = GraphMetadata::observe(hc::own_graph());
  bool was_set_ = false;
};

}  // namespace

hc::Result<std::unique_ptr<Recording>> open_mcap(hc::Module& module, McapOptions options,
                                                 const std::vector<std::string>& streams) {
  auto recorder = hc::mcap::Recorder::make(options);
  if (!recorder) return recorder.error();
  if (auto named = (*recorder)->set_frames(options.frames, module.now()); !named)
    return named.error();
  return std::unique_ptr<Recording>(
      std::make_unique<McapRecording>(module, std::move(options), streams, std::move(*recorder)));
}
