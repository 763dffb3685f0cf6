// SPDX-License-Identifier: Apache-2.0
#pragma once
// Creates files without overwriting existing data: the rule for everything that records
// (doc/recordings.md, "Nothing is overwritten").

#include <functional>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc {

/// Whether a path is a device, a FIFO, or a descriptor (/dev/stdout, /proc/self/fd/1): data is then
/// appended and never replaced.
bool is_written_in_place(const std::string& path);

/// The first free one of PATH, PATH_2, PATH_3, …
/// @param ending  such as ".mtp": if the path ends with it, the number is inserted before it.
std::string free_name(const std::string& path, std::string_view ending,
                      const std::function<bool(const std::string& path)>& is_free);

/// A file open for writing, and locked (flock) until it is closed.
struct NewFile {
  Descriptor descriptor;
  std::string path;
  bool is_new = false;  ///< created, not an empty file that existed
};

/// Creates a file, or opens an empty one. If the file has contents or another process is writing
/// it, the next free name is used: x_2.mtp for x.mtp. Devices and the like (is_written_in_place())
/// are opened for appending.
///
/// Errors: System, NotFound (the folder does not exist).
Result<NewFile> begin_file(const std::string& path);

/// Opens a file for reading and writing, to continue it; creates it if it does not exist. Errors:
/// System; also if another process is writing it.
Result<NewFile> continue_file(const std::string& path);

/// Replaces the contents of a file that can be regenerated. Readers see either the old or the new
/// contents, even after a crash or on a full disk. Concurrent calls are serialised with flock,
/// where the file system has it, and wait up to 2 s for each other. Devices and the like
/// (is_written_in_place()) are written directly.
///
/// Errors: System (also: another process does not finish), NotFound (the folder does not exist);
/// the file is then unchanged.
Status replace_file(const std::string& path, std::string_view contents);

/// Replaces a file, or a device, by a file that only its owner can read. Readers and concurrent
/// calls are served as by replace_file().
///
/// Errors: those of replace_file(), System (PATH.unfinished can be read by other users).
Status replace_private_file(const std::string& path, std::string_view contents);

/// Creates a file that only its owner can read, unless it exists. Concurrent calls, serialised as
/// above, leave the contents of one of them, complete.
///
/// Errors: those of replace_private_file().
Status make_private_file(const std::string& path, std::string_view contents);

}  // namespace hc
