// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/described_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam {

using nlohmann::json;

json::json_pointer Place::Pointer() const {
  if (parent_ == nullptr) return json::json_pointer();
  return key_.data() == nullptr ? parent_->Pointer() / index_
                                : parent_->Pointer() / std::string(key_);
}

namespace internal {
namespace {

std::string InWords(const Place& place) {
  const std::string pointer = place.Pointer().to_string();
  return pointer.empty() ? "the document" : pointer;
}

// "a number above 0 and at most 1"
std::string InWords(const char* type, const Limits& limits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<std::string> words;
  if (limits.min > -kInfinity) {
    words.push_back(fmt::format("{} {}", limits.excludes_min ? "above" : "at least", limits.min));
  }
  if (limits.max < kInfinity) words.push_back(fmt::format("at most {}", limits.max));
  return fmt::format("{}{}{}", type, words.empty() ? "" : " ", fmt::join(words, " and "));
}

bool IsWithin(const Limits& limits, double number) {
  return number <= limits.max && (limits.excludes_min ? number > limits.min : number >= limits.min);
}

}  // namespace

void Refuse(const Place& place, const json& found, const std::string& expected) {
  throw InputError(fmt::format("{} is {}; expected {}", InWords(place), Excerpt(found), expected));
}

void RefuseInWords(const Place& place, const std::string& violation) {
  const std::string pointer = place.Pointer().to_string();
  throw InputError(pointer.empty() ? violation : fmt::format("{}: {}", pointer, violation));
}

const json& RequireField(const json& object, const char* name, const Place& place) {
  CheckIsObject(object, place);
  const auto field = object.find(name);
  if (field == object.end()) {
    throw InputError(fmt::format("{} has no field \"{}\"; expected one", InWords(place), name));
  }
  return *field;
}

void RefuseUnknownFields(const json& object, const std::vector<std::string_view>& names,
                         const Place& place) {
  for (const auto& item : object.items()) {
    if (std::ranges::find(names, item.key()) != names.end()) continue;
    RefuseInWords(place, fmt::format("has a field {}, which is unknown; expected {}",
                                     json(item.key()).dump(), fmt::join(names, ", ")));
  }
}

double ReadNumber(const json& json, const Limits& limits, const Place& place) {
  if (!json.is_number() || !IsWithin(limits, json.get<double>())) {
    Refuse(place, json, InWords("a number", limits));
  }
  return json.get<double>();
}

std::int64_t ReadWholeNumber(const json& json, Limits limits, const Place& place) {
  if (!json.is_number_integer() || !IsWithin(limits, json.get<double>())) {
    Refuse(place, json, InWords("a whole number", limits));
  }
  return json.get<std::int64_t>();
}

const std::string& ReadText(const json& json, const Limits& limits, const Place& place) {
  if (!json.is_string()) Refuse(place, json, "a text");
  const auto& text = json.get_ref<const std::string&>();
  if (static_cast<double>(text.size()) < limits.min)
    Refuse(place, json, "a text that is not empty");
  return text;
}

bool ReadTruth(const json& json, const Place& place) {
  if (!json.is_boolean()) Refuse(place, json, "true or false");
  return json.get<bool>();
}

size_t ReadName(const json& json, std::span<const char* const> names, const Place& place) {
  const auto found =
      json.is_string() ? std::ranges::find(names, json.get_ref<const std::string&>()) : names.end();
  if (found == names.end()) Refuse(place, json, fmt::format("one of {}", fmt::join(names, ", ")));
  return static_cast<size_t>(found - names.begin());
}

void CheckIsList(const json& json, size_t size, bool is_exact, const Place& place) {
  if (json.is_array() && (is_exact ? json.size() == size : json.size() >= size)) return;
  Refuse(place, json,
         !is_exact && size == 0 ? "a list"
                                : fmt::format("a list of {}{} item{}", is_exact ? "" : "at least ",
                                              size, size == 1 ? "" : "s"));
}

void CheckIsObject(const json& json, const Place& place) {
  if (!json.is_object()) Refuse(place, json, "an object with fields");
}

Schema NumberSchema(const char* type, const Limits& limits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto number = [](double value) {
    return value == std::round(value) && std::abs(value) < 1e15 ? Schema(std::llround(value))
                                                                : Schema(value);
  };
  Schema schema = {{"type", type}};
  if (limits.min > -kInfinity) {
    schema[limits.excludes_min ? "exclusiveMinimum" : "minimum"] = number(limits.min);
  }
  if (limits.max < kInfinity) schema["maximum"] = number(limits.max);
  return schema;
}

Schema ListSchema(Schema of_items, size_t least, size_t most) {
  Schema schema = {{"type", "array"}};
  if (least > 0) schema["minItems"] = least;
  if (most < std::numeric_limits<size_t>::max()) schema["maxItems"] = most;
  schema["items"] = std::move(of_items);
  return schema;
}

Schema OrNullSchema(Schema schema) {
  if (schema.contains("enum")) {
    schema["enum"].push_back(nullptr);
  } else if (schema.contains("type")) {
    schema["type"] = {schema["type"], "null"};
  }
  return schema;
}

}  // namespace internal

internal::Schema SchemaWriter::Take() {
  using internal::Schema;
  if (!items_.empty()) {
    return {{"type", "array"},
            {"minItems", items_.size()},
            {"maxItems", items_.size()},
            {"items", std::move(items_)}};
  }
  Schema object = {{"type", "object"},
                   {"additionalProperties", false},
                   {"required", std::move(required_)},
                   {"properties", std::move(properties_)}};
  if (text_.is_null()) return object;
  return {{"oneOf", Schema::array({std::move(text_), std::move(object)})}};
}

}  // namespace soslam
