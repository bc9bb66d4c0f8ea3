// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <utility>

namespace soslam {
namespace {

constexpr double kTerminalInterval_s = 0.2;
constexpr double kLineInterval_s = 5.0;
constexpr int kBarWidth = 20;
constexpr const char* kEraseLine = "\r\x1b[K";

std::optional<ProgressDisplay>& DisplayOfProgram() {
  static std::optional<ProgressDisplay> display;
  return display;
}

double SteadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

ProgressOnStderr::ProgressOnStderr(const std::string& program) {
  DisplayOfProgram() =
      ProgressDisplay{&std::cerr, isatty(STDERR_FILENO) == 1, program, &SteadySeconds};
}

ProgressOnStderr::~ProgressOnStderr() { DisplayOfProgram().reset(); }

Progress::Progress(std::string what, int count)
    : Progress(std::move(what), count, DisplayOfProgram()) {}

Progress::Progress(std::string what, int count, std::optional<ProgressDisplay> display)
    : what_(std::move(what)), count_(count), display_(std::move(display)) {
  if (display_) start_s_ = shown_s_ = display_->seconds();
}

Progress::~Progress() {
  if (is_drawn_) *display_->stream << kEraseLine << std::flush;
}

void Progress::Step() {
  if (!display_) return;
  const std::lock_guard lock(mutex_);
  ++done_;
  const double now_s = display_->seconds();
  if (now_s - shown_s_ < (display_->is_terminal ? kTerminalInterval_s : kLineInterval_s)) return;
  shown_s_ = now_s;
  const std::string text = Text(now_s - start_s_);
  if (display_->is_terminal) {
    *display_->stream << kEraseLine << Bar() << text << std::flush;
    is_drawn_ = true;
  } else {
    *display_->stream << display_->program << ": " << text << std::endl;
  }
}

std::string Progress::Text(double elapsed_s) const {
  const double rate = done_ / elapsed_s;
  if (count_ == kUnknownCount) return fmt::format("{} {}, {:.3g}/s", done_, what_, rate);
  const auto seconds = static_cast<long long>(std::ceil((count_ - done_) / rate));
  std::string left = fmt::format("{} s", seconds);
  if (seconds >= 60) left = fmt::format("{} min {} s", seconds / 60, seconds % 60);
  if (seconds >= 3600) left = fmt::format("{} h {} min", seconds / 3600, seconds % 3600 / 60);
  return fmt::format("{}/{} {}, {:.3g}/s, {} left", done_, count_, what_, rate, left);
}

std::string Progress::Bar() const {
  if (count_ == kUnknownCount) return "";
  const auto filled = static_cast<size_t>(static_cast<int64_t>(kBarWidth) * done_ / count_);
  return fmt::format("[{:.<{}}] ", std::string(filled, '#'), kBarWidth);
}

}  // namespace soslam
