// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cyclone DDS messages as plain CDR bytes, so that no types are compiled in.

#include <cstddef>
#include <span>
#include <string>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <ros/cdr.h>

/// A topic type by its DDS name, without key or type information.
/// @param max_bytes  longer messages arrive without bytes: is_too_large().
ddsi_sertype* make_blob_type(const std::string& name, std::size_t max_bytes);

/// A message for dds_writecdr(), which takes ownership.
ddsi_serdata* make_blob(const ddsi_sertype& type, const hc::ros::Pieces& pieces);

/// The bytes of a message from dds_takecdr(), with the encapsulation header.
std::span<const std::byte> bytes_of(const ddsi_serdata& blob);
bool is_too_large(const ddsi_serdata& blob);
