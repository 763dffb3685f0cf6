// SPDX-License-Identifier: Apache-2.0
// ZeroMQ around a program in Python: zeromq ROLE ENDPOINT BYTES COUNT RATE. Each message begins
// with a number of eight bytes: its time where there is a rate, else how many were sent.
#include <zmq.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <string>
#include <thread>

namespace {

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

int send_all(void* socket, std::size_t bytes, std::int64_t count, double rate) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::int64_t sent = 1; sent <= count; ++sent) {
    if (rate > 0)
      std::this_thread::sleep_until(
          begin + std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate) * sent));
    zmq_msg_t message;
    zmq_msg_init_size(&message, bytes);
    std::memset(zmq_msg_data(&message), static_cast<int>(sent & 0xff), bytes);
    const std::int64_t first = rate > 0 ? now() : sent;
    std::memcpy(zmq_msg_data(&message), &first, sizeof first);
    if (zmq_msg_send(&message, socket, 0) < 0) return 1;
  }
  return 0;
}

int receive_all(void* socket, std::int64_t count) {
  std::int64_t begin = 0;
  for (std::int64_t taken = 1; taken <= count; ++taken) {
    zmq_msg_t message;
    zmq_msg_init(&message);
    if (zmq_msg_recv(&message, socket, 0) < 0) return 1;
    const auto* bytes = static_cast<const std::uint8_t*>(zmq_msg_data(&message));
    const auto size = zmq_msg_size(&message);
    const auto sum = std::accumulate(bytes + 8, bytes + size, std::uint64_t{0});
    if (sum != static_cast<std::uint8_t>(~taken) * (size - 8)) return 1;
    zmq_msg_close(&message);
    if (taken == count / 10) begin = now();
  }
  const auto seconds = static_cast<double>(now() - begin) * 1e-9;
  std::printf("%f\n", static_cast<double>(count - count / 10) / seconds);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const bool is_source = std::string(argv[1]) == "source";
  void* context = zmq_ctx_new();
  void* socket = zmq_socket(context, is_source ? ZMQ_PUSH : ZMQ_PULL);
  const auto bytes = static_cast<std::size_t>(std::atoll(argv[3]));
  const int depth = bytes > 10000 ? 4 : 1000, no_linger = 0;
  zmq_setsockopt(socket, ZMQ_LINGER, &no_linger, sizeof no_linger);
  zmq_setsockopt(socket, ZMQ_SNDHWM, &depth, sizeof depth);
  zmq_setsockopt(socket, ZMQ_RCVHWM, &depth, sizeof depth);
  if (zmq_bind(socket, argv[2]) != 0) return 1;
  const int status = is_source ? send_all(socket, bytes, std::atoll(argv[4]), std::atof(argv[5]))
                               : receive_all(socket, std::atoll(argv[4]));
  zmq_close(socket);
  zmq_ctx_term(context);
  return status;
}
