// SPDX-License-Identifier: Apache-2.0
#pragma once
// What ROS 2 calls things in DDS. Pure.

#include <string>
#include <string_view>

#include <ros/schema.h>

/// Hash of rmw_dds_common/msg/ParticipantEntitiesInfo, which says which nodes there are.
inline constexpr std::string_view kDiscoveryHash =
    "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e";

/// Hash of a type (RIHS01), by which ROS knows it; empty: it has none here, and no topic.
std::string_view hash_of(hc::ros::Type type);

/// "sensor_msgs/msg/Image" as "sensor_msgs::msg::dds_::Image_".
std::string dds_type(std::string_view name);

/// "/camera/image" as "rt/camera/image".
std::string dds_topic(std::string_view topic);

/// Whether it is a whole name of a topic of ROS: "/camera/image_raw".
bool is_topic(std::string_view name);
/// Whether it is a name of a node: letters, digits and _, no digit first.
bool is_node(std::string_view name);
