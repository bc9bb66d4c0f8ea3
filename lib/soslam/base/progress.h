// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>

namespace soslam {

// Stream and format of the progress display: one line that is redrawn on a terminal, otherwise a
// new line every few seconds.
struct ProgressDisplay {
  std::ostream* stream;
  bool is_terminal;
  std::string program;              // prefix of each line that is not on a terminal
  std::function<double()> seconds;  // monotonic clock with any origin
};

// While this lives, each new Progress is shown on stderr; otherwise progress is not shown.
class ProgressOnStderr {
 public:
  explicit ProgressOnStderr(const std::string& program);
  ~ProgressOnStderr();
  ProgressOnStderr(const ProgressOnStderr&) = delete;
  ProgressOnStderr& operator=(const ProgressOnStderr&) = delete;
};

// Progress of a long loop: the count, the rate, and the time left. Shows nothing for loops that end
// within a moment. May be stepped from several threads.
class Progress {
 public:
  static constexpr int kUnknownCount = -1;

  // Counts `what` (a plural, "frames") up to `count` and shows it on the program's display.
  Progress(std::string what, int count);
  Progress(std::string what, int count, std::optional<ProgressDisplay> display);
  // Erases the progress line on a terminal.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Counts one item as done.
  void Step();

 private:
  std::string Text(double elapsed_s) const;
  std::string Bar() const;

  std::string what_;
  int count_;
  std::optional<ProgressDisplay> display_;
  std::mutex mutex_;
  int done_ = 0;
  double start_s_ = 0.0;
  double shown_s_ = 0.0;  // time of the last display
  bool is_drawn_ = false;
};

}  // namespace soslam
