// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/schema.h"

#include <fmt/format.h>

#include <stdexcept>

#include "artefact/json_file.h"
#include "base/error.h"

// Silences GCC 12, which falsely reports an overflow in a std::string::replace inlined into
// valijson.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wstringop-overflow"
#pragma GCC diagnostic ignored "-Wrestrict"
#endif
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

namespace soslam {
namespace {

using nlohmann::json;
using Adapter = valijson::adapters::NlohmannJsonAdapter;

// JSON pointer of valijson's context: ("<root>", "[objects]", "[0]") is /objects/0.
json::json_pointer Place(const std::vector<std::string>& context) {
  json::json_pointer place;
  for (size_t i = 1; i < context.size(); ++i) {
    place /= context[i].substr(1, context[i].size() - 2);
  }
  return place;
}

}  // namespace

std::optional<std::string> ViolationOf(const json& document, const json& schema_document) {
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7)
      .populateSchema(Adapter(schema_document), schema);

  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, Adapter(document), &results)) return std::nullopt;
  // The deepest error is reported first; later ones are its consequences further up.
  const valijson::ValidationResults::Error& error = *results.begin();
  const json::json_pointer place = Place(error.context);
  return fmt::format("{} is {}: {}", place.empty() ? "the document" : place.to_string(),
                     Excerpt(document.at(place)), error.description);
}

std::optional<std::string> SchemaViolation(const json& document, const std::string& kind) {
  const auto text = EmbeddedSchemas().find(kind);
  if (text == EmbeddedSchemas().end()) throw std::logic_error("no schema of kind " + kind);
  return ViolationOf(document, json::parse(text->second));
}

void ValidateAgainstSchema(const json& document, const std::string& kind, const std::string& file) {
  if (const auto violation = SchemaViolation(document, kind)) {
    throw InputError(file + ": " + *violation);
  }
}

}  // namespace soslam
