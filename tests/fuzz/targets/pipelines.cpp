// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "workflow/pipeline_settings.h"

namespace soslam {
namespace {

const FuzzTarget kPipelines("pipelines", [](const HostileInput& input) {
  const auto folder = input.AsFolder();
  std::vector<std::string> variants;
  if (!IsAccepted(folder, [&] { variants = VariantNames(folder); })) return;
  for (const std::string& variant : variants) {
    IsAccepted(folder, [&] { ReadVariant(folder, "room", variant); });
  }
});

}  // namespace
}  // namespace soslam
