// SPDX-License-Identifier: Apache-2.0
#pragma once
// Names of ROS 2 topics, types and nodes in DDS. Pure.

#include <string>
#include <string_view>

#include <ros/schema.h>

/// Hash of rmw_dds_common/msg/ParticipantEntitiesInfo, which announces nodes.
inline constexpr std::string_view kDiscoveryHash =
    "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e";

/// Type hash (RIHS01); empty if the type is not supported in topics.
std::string_view hash_of(hc::ros::Type type);

/// "sensor_msgs/msg/Image" as "sensor_msgs::msg::dds_::Image_".
std::string dds_type(std::string_view name);

/// "/camera/image" as "rt/camera/image".
std::string dds_topic(std::string_view topic);

/// Whether this is an absolute ROS topic name: "/camera/image_raw".
bool is_topic(std::string_view name);
/// Whether this is a node name: letters, digits and _, not starting with a digit.
bool is_node(std::string_view name);
