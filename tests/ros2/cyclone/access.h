// SPDX-License-Identifier: Apache-2.0
#pragma once
// How what idlc made is named and changed (../samples.h).

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

#include "ros.h"

#define M(member) member
#define TYPE(package, name) package##_msg_dds__##name##_

template <typename T>
void resize(T& list, std::size_t size) {
  using Item = std::remove_pointer_t<decltype(list._buffer)>;
  if (size > list._length)
    list._buffer = static_cast<Item*>(dds_realloc_zero(list._buffer, size * sizeof(Item)));
  list._length = list._maximum = static_cast<std::uint32_t>(size);
  list._release = true;
}
template <typename T>
std::size_t length(const T& list) {
  return list._length;
}
template <typename T>
auto& item(T& list, std::size_t at) {
  return list._buffer[at];
}
inline void set_text(char*& member, const char* text) {
  dds_string_free(member);
  member = dds_string_dup(text);
}
inline std::string text_of(const char* member) {
  return member == nullptr ? "" : member;
}
