// SPDX-License-Identifier: Apache-2.0
#include <frames/messages.h>
#include <frames/tree.h>

#include <iostream>

int main() {
  auto tree = hc::frames::Tree::standard();
  if (hc::pose_of(hc::Message())) return 1;  // a message without elements
  auto found = tree.lookup("head", "world", hc::unix_time(1));
  std::cout << (found ? "found" : found.error().detail) << "\n";
}
