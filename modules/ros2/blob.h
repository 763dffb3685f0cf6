// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages of Cyclone DDS that are bytes of CDR and nothing more: of any type, none compiled in.

#include <cstddef>
#include <span>
#include <string>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <ros/cdr.h>

/// A topic type by its DDS name, without a key and without type information.
/// @param max_bytes  longer messages come without their bytes: is_too_large().
ddsi_sertype* make_blob_type(const std::string& name, std::size_t max_bytes);

/// A message for dds_writecdr(), which takes it over.
ddsi_serdata* make_blob(const ddsi_sertype& type, const hc::ros::Pieces& pieces);

/// What dds_takecdr() gave: its bytes, with their encapsulation header.
std::span<const std::byte> bytes_of(const ddsi_serdata& blob);
bool is_too_large(const ddsi_serdata& blob);
