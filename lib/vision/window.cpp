// SPDX-License-Identifier: Apache-2.0
#include <vision/window.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include <opencv2/highgui.hpp>
#include <opencv2/imgcodecs.hpp>

namespace hc::vision {

bool has_display() {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return false;
  pid_t child = ::fork();
  if (child == 0) {
    rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
    try {
      cv::namedWindow("hypercolumn");
    } catch (const cv::Exception&) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  int status = 1;
  return child > 0 && ::waitpid(child, &status, 0) == child && status == 0;
}

Status save_image(const std::filesystem::path& path, const cv::Mat& bgr) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  std::filesystem::path unfinished = path;
  unfinished.replace_extension(".part.png");
  if (!error && !cv::imwrite(unfinished.string(), bgr))
    return Error{Code::System, path.string() + ": cannot be written"};
  if (!error) std::filesystem::rename(unfinished, path, error);
  if (error) return Error{Code::System, path.string() + ": " + error.message()};
  return {};
}

}  // namespace hc::vision
