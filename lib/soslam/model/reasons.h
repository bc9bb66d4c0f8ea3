// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace soslam {

// Reason for leaving out a detection, a track, an object or an image. Artefacts have its code, as
// the enumerations name it; messages and pages have its words.
struct Reason {
  std::string code;
  std::string words;  // of what is left out, also after a number: "too near the image border"
  // The likely cause and the remedy where much is left out; empty where that is no mistake.
  std::string cause = {};
  std::string remedy = {};
};

// The reason with this code in the one table of all stages. Codes that say enough are not there;
// their words are the code with blanks: "no_edges" is "no edges".
Reason ReasonOf(const std::string& code);

// Counts by code as counts by words.
std::map<std::string, int> ReasonsInWords(const std::map<std::string, int>& counts);

}  // namespace soslam
