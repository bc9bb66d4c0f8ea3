// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/label_file.h"

#include <fmt/format.h>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {

std::vector<std::string> ReadLabelFile(const std::filesystem::path& path) {
  std::vector<std::string> labels;
  for (const TextLine& line : ReadTextLines(path)) {
    if (line.text.find(',') != std::string::npos) {
      throw InputError(fmt::format("{}: label is '{}'; expected one name a line, without a comma",
                                   line.place, line.text));
    }
    labels.push_back(line.text);
  }
  if (labels.empty()) throw InputError(path.string() + ": has no label; expected one a line");
  return labels;
}

}  // namespace soslam
