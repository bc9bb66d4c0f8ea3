// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/semantic_table_file.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kSemanticTable("semantic_table", [](const HostileInput& input) {
  const auto file = input.AsFile("semantic_table.json");
  SemanticRows rows;
  IsAccepted(file, [&] { ReadSemanticTable(file); });
  if (!IsAccepted(file, [&] { rows = ReadSemanticRows(file); })) return;
  WriteSemanticRows(input.Output("semantic_table.json"), rows, {});
});

}  // namespace
}  // namespace soslam
