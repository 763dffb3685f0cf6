// SPDX-License-Identifier: Apache-2.0
#include <linux/filter.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <vector>

#include <dds/ddsrt/log.h>

#include <dds/participant.h>
#include <dds/sockets.h>
#include <hc/os/descriptor.h>

namespace hc::dds {
namespace {

/// Distributes the warnings of Cyclone DDS, which has one log per process, by domain.
class Log {
 public:
  void add(std::uint32_t domain, std::shared_ptr<internal::Remarks> remarks) {
    dds_set_log_sink(  // Cyclone DDS holds its lock while it calls take()
        [](void* log, const dds_log_data_t* line) { static_cast<Log*>(log)->take(*line); }, this);
    const std::lock_guard lock(mutex_);
    readers_[domain] = {std::move(remarks), {}};
  }
  void remove(std::uint32_t domain) {
    const std::lock_guard lock(mutex_);
    readers_.erase(domain);
  }

 private:
  void take(const dds_log_data_t& line) {
    const std::lock_guard lock(mutex_);
    const auto found = readers_.find(line.domid);
    // Each warning is logged once, whatever other participants send.
    if (found == readers_.end() || !found->second.said.insert({line.file, line.line}).second)
      return;
    std::string_view text(line.message, line.size);
    while (text.ends_with('\n')) text.remove_suffix(1);
    found->second.remarks->add("Cyclone DDS: " + std::string(text));
  }

  struct Reader {
    std::shared_ptr<internal::Remarks> remarks;
    std::set<std::pair<std::string, std::uint32_t>> said;  // by line of the source code
  };

  std::mutex mutex_;
  std::map<std::uint32_t, Reader> readers_;
};

Log& log_of_all() {
  static auto* log = new Log;  // never destroyed: Cyclone's threads may outlive main()
  return *log;
}

/// The number of a domain within this process, independent of its number in the network, so that it
/// differs from those of other users of Cyclone DDS in the process.
std::uint32_t next_number() {
  constexpr std::uint32_t kFirst = 1'000'000;
  static std::atomic<std::uint32_t> next{kFirst};
  return next++;
}

/// Makes a socket drop packets from other interfaces; Cyclone DDS listens on all of them.
Status accept_only(int socket, const std::vector<unsigned>& interfaces) {
  constexpr auto kInterface = static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_IFINDEX);
  std::vector<sock_filter> program = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kInterface)};
  for (std::size_t i = 0; i < interfaces.size(); ++i)
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, interfaces[i],
                               static_cast<std::uint8_t>(interfaces.size() - i), 0));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, 0));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, 0xffffffff));
  const sock_fprog filter = {static_cast<unsigned short>(program.size()), program.data()};
  if (::setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) != 0)
    return system_error("setsockopt", "SO_ATTACH_FILTER");
  return {};
}

}  // namespace

QosOwner make_qos() {
  QosOwner qos(dds_create_qos());
  constexpr dds_duration_t kNever = 0;  // do not block the writer
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kNever);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &representation);
  return qos;
}

Participant::Participant(std::uint32_t number)
    : number_(number), remarks_(std::make_shared<internal::Remarks>()) {}

Result<std::unique_ptr<Participant>> Participant::open(const Place& place, const Limits& limits) {
  constexpr std::uint64_t kMostBytes = (std::uint64_t{1} << 31) - 1;  // of a sample
  auto interfaces = HC_TRY(find_interfaces(place));
  std::unique_ptr<Participant> made(new Participant(next_number()));
  log_of_all().add(made->number_, made->remarks_);
  const auto most = std::min(
      std::max<std::uint64_t>(limits.element_bytes + kMaxHeaderBytes + 64 + kFrame, kMaxJoined),
      kMostBytes);
  const auto domain = dds_create_domain(made->number_, configuration(place, most).c_str());
  if (domain < 0) return failed("domain " + std::to_string(place.domain), domain);
  made->domain_ = Entity(domain);
  const auto participant = dds_create_participant(made->number_, nullptr, nullptr);
  if (participant < 0)
    return failed("cannot join domain " + std::to_string(place.domain) +
                      ", which allows 120 participants per host",
                  participant);
  made->participant_ = Entity(participant);
  auto* type = make_type();
  const auto topic =
      dds_create_topic_sertype(participant, place.topic.c_str(), &type, nullptr, nullptr, nullptr);
  if (topic < 0) {
    ddsi_sertype_unref(type);
    return failed("topic " + place.topic, topic);
  }
  made->topic_ = Entity(topic);
  made->type_ = type;
  HC_TRY(made->drop_other_interfaces(interfaces));
  return made;
}

Status Participant::drop_other_interfaces(const std::vector<unsigned>& interfaces) const {
  std::array<int, HC_DDS_MOST_SOCKETS> sockets{};
  const auto count = static_cast<std::size_t>(hc_dds_sockets(type_, sockets.data()));
  for (const int socket : std::span(sockets).first(count)) HC_TRY(accept_only(socket, interfaces));
  return {};
}

Participant::~Participant() {
  topic_.reset();
  participant_.reset();
  domain_.reset();
  log_of_all().remove(number_);
}

Status Entrance::begin(Place place, const Event& event) {
  place_ = std::move(place);
  return timer_.start(-1, [&event](auto) { event.raise(); });
}

Result<std::unique_ptr<Participant>> Entrance::open(const LinkOptions& options) {
  constexpr std::chrono::seconds kPause{1};
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return std::unique_ptr<Participant>();
  auto opened = Participant::open(place_, options.limits);
  if (opened || opened.error().code != Code::NotFound) return opened;
  if (!missing_ && options.log) options.log(Level::Warning, opened.error().detail + "; waiting");
  missing_ = opened.error();
  next_ = now + kPause;
  timer_.call_at(next_);
  return std::unique_ptr<Participant>();
}

}  // namespace hc::dds
