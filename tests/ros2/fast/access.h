// SPDX-License-Identifier: Apache-2.0
#pragma once
// How what fastddsgen made is named and changed (../samples.h).

#include <string>
#include <vector>

#if __has_include("rosPubSubTypes.hpp")  // of fastddsgen 4, for Fast DDS 3
#include "rosPubSubTypes.hpp"
#else
#include "rosPubSubTypes.h"
#endif

#define M(member) member()
#define TYPE(package, name) package::msg::dds_::name##_

template <typename T>
void resize(std::vector<T>& list, std::size_t size) {
  list.resize(size);
}
template <typename T>
std::size_t length(const std::vector<T>& list) {
  return list.size();
}
template <typename T>
T& item(std::vector<T>& list, std::size_t at) {
  return list[at];
}
inline void set_text(std::string& member, const char* text) {
  member = text;
}
inline std::string text_of(const std::string& member) {
  return member;
}
