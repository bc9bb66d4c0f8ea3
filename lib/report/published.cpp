// SPDX-License-Identifier: BSD-3-Clause
#include "report/published.h"

#include <algorithm>

#include "artefact/json_file.h"
#include "artefact/schema.h"

namespace soslam {
namespace {

using nlohmann::json;

PublishedRow RowFromJson(const json& row) {
  return {row.value("dataset", "average"), row["objects"], row["values"]};
}

PublishedTable TableFromJson(const json& document) {
  PublishedTable table = {document["table"],
                          document["quantity"],
                          document["source"],
                          {},
                          RowFromJson(document["average"])};
  for (const json& row : document["rows"]) table.rows.push_back(RowFromJson(row));
  return table;
}

PublishedTimes TimesFromJson(const json& document) {
  PublishedTimes times = {document["source"], document["dataset"], document["machine"], {}};
  for (const json& time : document["values"]) {
    times.values.push_back(
        {time["variant"], time["ms_mean"], time["ms_sigma"], time["observations"]});
  }
  return times;
}

}  // namespace

const PublishedTable* Published::Find(const std::string& number, const Quantity& quantity) const {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const PublishedTable& table) {
    return table.number == number && table.quantity == quantity.key;
  });
  return found == tables.end() ? nullptr : &*found;
}

Published ReadPublished(const std::filesystem::path& path) {
  const json document = ParseJsonFile(path);
  ValidateAgainstSchema(document, "published", path.string());
  Published published;
  for (const json& table : document["tables"]) published.tables.push_back(TableFromJson(table));
  published.times = TimesFromJson(document["times"]);
  return published;
}

}  // namespace soslam
