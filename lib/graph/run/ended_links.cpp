// SPDX-License-Identifier: Apache-2.0
#include <graph/run/ended_links.h>

namespace hc::internal {

void EndedLinks::settle() {
  std::map<LinkName, const PlannedLink*> to_read;  // instead of their readers
  for (const auto& link : plan_.links) {
    const Supervised* writer = modules_.at(link.from);
    Supervised* reader = modules_.at(link.to);
    if (writer == nullptr || reader == nullptr) continue;
    if (reader->is_over() && !writer->is_over()) to_read[{link.from, link.to}] = &link;
    if (reader->is_over() || !link.reconnects) continue;
    const bool has_ended =
        reader->plan().is_recorder ? writer->is_over() : writer->status() == ModuleStatus::Ended;
    reader->finish_input(link.end(true), has_ended);
  }
  std::erase_if(drains_, [&](const auto& entry) { return !to_read.contains(entry.first); });
  for (const auto& [name, link] : to_read) {
    if (drains_.contains(name)) continue;
    auto drain = drain_for(modules_.at(link->to)->plan(), link->reader_uri);
    if (!drain) log_.add(link->reader_uri + ": " + drain.error().text(), Level::Warning);
    drains_[name] = drain ? std::move(*drain) : nullptr;
  }
  end_unneeded();
}

/// Reads a link in place of a module that has ended, on its host.
Result<std::shared_ptr<void>> EndedLinks::drain_for(const PlannedModule& reader,
                                                    const std::string& uri) const {
  if (!reader.host.empty() && hosts_ != nullptr)
    if (auto host = hosts_->find(reader.host)) return host->read_in_place(uri);
  return read_in_place_here(loop_, uri, hosts_ == nullptr ? -1 : hosts_->key());
}

/// Ends modules whose readers have all finished.
void EndedLinks::end_unneeded() {
  std::map<std::string, bool> is_needed;  // by writer
  for (const auto& link : plan_.links) {
    const Supervised* reader = modules_.at(link.to);
    const bool is_done = reader != nullptr && reader->status() == ModuleStatus::Ended;
    bool& needed = is_needed[link.from.substr(0, link.from.find('.'))];
    needed = needed || !is_done;
  }
  for (const auto& [name, needed] : is_needed) {
    Supervised* writer = modules_.find(name);
    if (needed || writer == nullptr || writer->is_over() || writer->is_to_end() ||
        writer->plan().restart == Restart::Always)
      continue;
    writer->dismiss();
  }
}

}  // namespace hc::internal
