// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/findings_json.h"

namespace soslam {

using nlohmann::json;

json FindingsToJson(const std::vector<Finding>& findings) {
  json list = json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"check", finding.check},
                    {"severity", kSeverityNames[static_cast<size_t>(finding.severity)]},
                    {"found", finding.found},
                    {"expected", finding.expected},
                    {"cause", finding.cause},
                    {"remedy", finding.remedy}});
  }
  return list;
}

std::vector<Finding> FindingsFromJson(const json& artefact) {
  std::vector<Finding> findings;
  for (const json& entry : artefact.value("findings", json::array())) {  // since version 1.6
    const bool is_error = entry.at("severity") == kSeverityNames[1];
    findings.push_back(
        {entry.at("check").get<std::string>(), is_error ? Severity::kError : Severity::kWarning,
         entry.at("found").get<std::string>(), entry.at("expected").get<std::string>(),
         entry.at("cause").get<std::string>(), entry.at("remedy").get<std::string>()});
  }
  return findings;
}

}  // namespace soslam
