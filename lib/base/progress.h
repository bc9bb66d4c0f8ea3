// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>

namespace soslam {

// Where and how progress is shown: on a terminal as one line that is drawn again and again, else as
// a line every few seconds.
struct ProgressDisplay {
  std::ostream* stream;
  bool is_terminal;
  std::string program;              // before each line that is not on a terminal
  std::function<double()> seconds;  // from any moment on, never backwards
};

// While this lives, the progress of what begins is shown on stderr; otherwise nowhere.
class ProgressOnStderr {
 public:
  explicit ProgressOnStderr(const std::string& program);
  ~ProgressOnStderr();
  ProgressOnStderr(const ProgressOnStderr&) = delete;
  ProgressOnStderr& operator=(const ProgressOnStderr&) = delete;
};

// How far a long loop is: the count, the rate, and the time left. Shows nothing about loops that
// end within a moment. May be stepped from several threads.
class Progress {
 public:
  static constexpr int kUnknownCount = -1;

  // `what` is counted, in the plural ("frames"), up to `count`, on the display of the program.
  Progress(std::string what, int count);
  Progress(std::string what, int count, ProgressDisplay display);
  // Leaves the terminal as it was.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // One more is done.
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
  double shown_s_ = 0.0;  // when last shown
  bool is_drawn_ = false;
};

}  // namespace soslam
