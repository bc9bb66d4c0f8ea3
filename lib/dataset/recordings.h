// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace soslam {

// Settings for KITTI's numbered recordings, whose files are named by number: "0013.txt". All
// functions throw SettingsError naming the option.

// Recordings `first` to `last`, inclusive.
struct RecordingRange {
  int first = 0;
  int last = 0;
  bool Contains(int recording) const { return recording >= first && recording <= last; }
};

// Parses "0001 0003-0005", blanks between ranges.
std::vector<RecordingRange> ParseRecordings(const std::string& option, std::string_view text);

// Values per recording, "0000-0013:0.969 0020:0.988", or one value for all.
class RecordingValues {
 public:
  RecordingValues(const std::string& option, const std::string& text);
  // Value of a recording. Throws SettingsError when there is none.
  const std::string& Of(int recording) const;
  // Value of a recording as a number above 0.
  double PositiveOf(int recording) const;

 private:
  struct Entry {
    RecordingRange range;
    std::string value;
  };
  std::string option_;
  std::vector<Entry> entries_;
};

}  // namespace soslam
