// SPDX-License-Identifier: Apache-2.0
#include "names.h"

#include <algorithm>
#include <cctype>
#include <utility>

std::string_view hash_of(hc::ros::Type type) {
  using hc::ros::Type;
  static constexpr std::pair<Type, std::string_view> kHashes[] = {
      {Type::Float64MultiArray, "1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f"},
      {Type::Image, "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
      {Type::CompressedImage, "15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a"},
      {Type::PointCloud2, "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
      {Type::CameraInfo, "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
      {Type::PoseStamped, "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
      {Type::Twist, "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"},
      {Type::TfMessage, "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {Type::JointState, "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
      {Type::String, "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"}};
  for (const auto& [each, hash] : kHashes)
    if (each == type) return hash;
  return "";
}

std::string dds_type(std::string_view name) {
  const auto first = name.find('/'), last = name.rfind('/');
  return std::string(name.substr(0, first)) + "::msg::dds_::" + std::string(name.substr(last + 1)) +
         "_";
}

std::string dds_topic(std::string_view topic) {
  return "rt" + std::string(topic);
}

bool is_topic(std::string_view name) {
  constexpr std::size_t kMost = 247;  // maximum of DDS, less the prefix of ROS
  if (name.size() < 2 || name.size() > kMost || name.front() != '/') return false;
  while (!name.empty()) {
    name.remove_prefix(1);
    const auto part = name.substr(0, name.find('/'));
    if (!is_node(part)) return false;
    name.remove_prefix(part.size());
  }
  return true;
}

bool is_node(std::string_view name) {
  auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::ranges::all_of(name, is_part);
}
