// SPDX-License-Identifier: Apache-2.0
#pragma once
// Files that are written without destroying what others have written: the one rule of all that
// records (doc/recordings.md, "Nothing is overwritten").

#include <functional>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc {

/// Whether a path is a device, a FIFO, or a descriptor by its name (/dev/stdout, /proc/self/fd/1):
/// what is written there goes behind what is there.
bool is_written_in_place(const std::string& path);

/// A path, or else the first that is free of PATH_2, PATH_3, …
/// @param ending  of a file's name, ".mtp": the number stands before it where the path has it.
std::string free_name(const std::string& path, std::string_view ending,
                      const std::function<bool(const std::string& path)>& is_free);

/// A file that is open for writing, and locked (flock) as long as it is.
struct NewFile {
  Descriptor descriptor;
  std::string path;
  bool is_new = false;  ///< no empty file had the name
};

/// Begins a file. One that has contents, or that another process is writing, stays as it is, and
/// the file is beside it: x_2.mtp for x.mtp. What is_written_in_place() is opened as it is.
///
/// Errors: System, NotFound (the folder does not exist).
Result<NewFile> begin_file(const std::string& path);

/// Opens a file for reading and writing where it is, to continue it; creates it where there is
/// none. Errors: System; also while another process writes it.
Result<NewFile> continue_file(const std::string& path);

/// Replaces what a file contains, for files that show the present and can be made again: readers
/// find the old or the new contents, also after a crash or on a full disk. Of several processes
/// that replace it at once, each waits up to 2 s for those before, where the file system has locks
/// (flock). What is_written_in_place() is written to.
///
/// Errors: System (also: another process does not finish); the file is as it was then.
Status replace_file(const std::string& path, std::string_view contents);

/// Makes a file that only its owner can read, unless it is there: of several that do so at once,
/// with locks as above, all find the same contents, and never a part of them.
///
/// Errors: System (also: PATH.unfinished is there, and others can read it), NotFound (the folder
/// does not exist).
Status make_private_file(const std::string& path, std::string_view contents);

}  // namespace hc
