// SPDX-License-Identifier: BSD-3-Clause
// Semantic tables: rows are labels.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "artefact/semantic_table_file.h"
#include "inspection/kinds.h"

namespace soslam {
namespace {

std::vector<Value> RowOf(const SemanticRow& row) {
  const ShapePrior& prior = row.prior;
  const bool has_height = prior.height_m.has_value();
  return {row.label,
          prior.ratio.x(),
          prior.ratio.y(),
          prior.log_sigma.x(),
          prior.log_sigma.y(),
          prior.log_correlation,
          has_height ? Value(prior.height_m->median) : Value(),
          has_height ? Value(prior.height_m->log_sigma) : Value(),
          prior.shape_exponent,
          kMountNames[static_cast<size_t>(prior.mount)],
          row.samples,
          row.aliases.empty() ? Value() : Value(fmt::format("{}", fmt::join(row.aliases, ", "))),
          row.source};
}

}  // namespace

Inspection InspectSemanticTable(const std::filesystem::path& file) {
  const SemanticRows rows = ReadSemanticRows(file);
  const auto learned =
      std::ranges::count_if(rows.rows, [](const SemanticRow& row) { return row.samples > 0; });
  Inspection inspection;
  inspection.facts = {
      {"what", rows.description},
      {"labels", fmt::format("{}, {} of them from samples; {} for others", rows.rows.size(),
                             learned, rows.default_row ? "a default" : "nothing")}};
  inspection.table.columns = {{"label", ""},
                              {"a_by_c", ""},
                              {"b_by_c", ""},
                              {"a_by_c_log_sigma", ""},
                              {"b_by_c_log_sigma", ""},
                              {"log_correlation", ""},
                              {"height", "m"},
                              {"height_log_sigma", ""},
                              {"p", ""},
                              {"mount", ""},
                              {"samples", ""},
                              {"aliases", ""},
                              {"source", ""}};
  if (rows.default_row) inspection.table.rows.push_back(RowOf(*rows.default_row));
  for (const SemanticRow& row : rows.rows) inspection.table.rows.push_back(RowOf(row));
  return inspection;
}

}  // namespace soslam
