// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/model/sequence.h"

// Absent values are null in every artefact.
template <typename Value>
struct nlohmann::adl_serializer<std::optional<Value>> {
  static void to_json(json& json, const std::optional<Value>& value) {
    json = value ? nlohmann::json(*value) : nlohmann::json();
  }
  static void from_json(const json& json, std::optional<Value>& value) {
    value = json.is_null() ? std::nullopt : std::optional(json.get<Value>());
  }
};

// Vectors are lists of numbers, matrices lists of their rows.
template <int kRows, int kColumns, int kOptions>
struct nlohmann::adl_serializer<Eigen::Matrix<double, kRows, kColumns, kOptions>> {
  static_assert(kRows > 1 && kColumns > 0, "a list of known length");
  using Matrix = Eigen::Matrix<double, kRows, kColumns, kOptions>;

  template <typename Json>
  static void to_json(Json& json, const Matrix& matrix) {
    json = Json::array();
    for (int i = 0; i < kRows; ++i) {
      const auto row = matrix.row(i);
      json.push_back(kColumns == 1 ? Json(row[0])
                                   : Json(std::vector<double>(row.begin(), row.end())));
    }
  }
  static void from_json(const json& json, Matrix& matrix) {
    for (int i = 0; i < kRows; ++i) {
      for (int k = 0; k < kColumns; ++k) {
        (kColumns == 1 ? json.at(i) : json.at(i).at(k)).get_to(matrix(i, k));
      }
    }
  }
};

namespace soslam {

// JSON and JSON schemas of structs by their descriptions, see base/description.h. Vectors are lists
// of numbers, matrices lists of their rows, quaternions x, y, z, w. Doubles round-trip bit by bit.

// How a value is described unless something else is given.
struct ByDescribe {
  template <typename Visitor, typename Value>
  void operator()(Visitor& visit, Value& value) const {
    Describe(visit, value);
  }
};

// A place in a document. It becomes a text, "/objects/0/half_axes", in error messages only.
class Place {
 public:
  Place() = default;
  Place(const Place& parent, std::string_view key) : parent_(&parent), key_(key) {}
  Place(const Place& parent, size_t index) : parent_(&parent), index_(index) {}
  nlohmann::json::json_pointer Pointer() const;

 private:
  const Place* parent_ = nullptr;
  std::string_view key_;
  size_t index_ = 0;
};

namespace internal {

template <template <typename...> typename Template, typename T>
inline constexpr bool kIs = false;
template <template <typename...> typename Template, typename... Parts>
inline constexpr bool kIs<Template, Template<Parts...>> = true;
template <typename T>
inline constexpr bool kIsArray = false;
template <typename T, size_t kSize>
inline constexpr bool kIsArray<std::array<T, kSize>> = true;
template <typename T>
concept IsMatrix = std::derived_from<T, Eigen::MatrixBase<T>>;
template <typename T>
concept IsText = std::same_as<T, std::string> || std::same_as<T, std::filesystem::path>;

// Far above the rounding of composed poses, but below the error of a number typed by hand.
inline constexpr double kUnitTolerance = 1e-6;

// Throws InputError: "/objects/0/half_axes/1 is -1; expected a number above 0".
[[noreturn]] void Refuse(const Place& place, const nlohmann::json& found,
                         const std::string& expected);
[[noreturn]] void RefuseInWords(const Place& place, const std::string& violation);
// Throws InputError unless `object` has this field, which is returned.
const nlohmann::json& RequireField(const nlohmann::json& object, const char* name,
                                   const Place& place);
// Throws InputError for a field that has none of these names.
void RefuseUnknownFields(const nlohmann::json& object, const std::vector<std::string_view>& names,
                         const Place& place);
// These throw InputError for another type and beyond the limits.
double ReadNumber(const nlohmann::json& json, const Limits& limits, const Place& place);
std::int64_t ReadWholeNumber(const nlohmann::json& json, Limits limits, const Place& place);
const std::string& ReadText(const nlohmann::json& json, const Limits& limits, const Place& place);
bool ReadTruth(const nlohmann::json& json, const Place& place);
size_t ReadName(const nlohmann::json& json, std::span<const char* const> names, const Place& place);
// Throws InputError unless `json` is a list of at least, or exactly, so many items.
void CheckIsList(const nlohmann::json& json, size_t size, bool is_exact, const Place& place);
void CheckIsObject(const nlohmann::json& json, const Place& place);
// Index of the item of this id. Throws InputError if there is none.
template <typename Item>
int IndexOfIdAt(const Place& place, const std::vector<Item>& items, const nlohmann::json& id) {
  const auto found = std::ranges::lower_bound(items, id.get<int>(), {}, &Item::id);
  if (found == items.end() || found->id != id.get<int>()) {
    Refuse(place, id, "an id of the sequence");
  }
  return static_cast<int>(found - items.begin());
}

using Schema = nlohmann::ordered_json;
Schema NumberSchema(const char* type, const Limits& limits);
Schema ListSchema(Schema of_items, size_t least, size_t most);
// The schema that null satisfies, too.
Schema OrNullSchema(Schema schema);

// The visits that only readers use.
struct VisitorThatDoesNotRead {
  template <typename Violation>
  void Check(const Violation&) {}
  template <typename Action>
  void AfterReading(const Action&) {}
};

}  // namespace internal

// Writes one struct.
class JsonWriter : public internal::VisitorThatDoesNotRead {
 public:
  explicit JsonWriter(const Sequence* sequence) : sequence_(sequence) {}

  template <typename Value, typename Describer = ByDescribe>
  void Field(const char* name, const Value* value, const char* /*doc*/, const Limits& = {},
             const Describer& describe = {}) {
    json_[name] = ToJson(*value, describe);
  }
  template <typename Value, typename Describer = ByDescribe>
  void OrNull(const char* name, const Value* value, const char* /*doc*/, const Limits& = {},
              const Describer& describe = {}) {
    json_[name] = *value == Value() ? nlohmann::json() : ToJson(*value, describe);
  }
  template <typename Value, typename Describer = ByDescribe>
  void OrAbsent(const char* name, const Value* value, const char* /*doc*/, const Limits& = {},
                const Describer& describe = {}) {
    if (!IsAbsent(*value)) json_[name] = ToJson(*value, describe);
  }
  template <typename Value>
  void OrDefault(const char* name, const Value* value, const Value& /*absent*/, const char* doc,
                 const Limits& limits = {}) {
    Field(name, value, doc, limits);
  }
  template <typename Value>
  void Unit(const char* name, const Value* value, const char* doc) {
    Field(name, value, doc);
  }
  bool IsText(const std::string* /*text*/, const char* /*doc*/) { return false; }
  template <typename Value>
  void Item(const Value* value, const char* /*doc*/, const Limits& = {}) {
    if (!json_.is_array()) json_ = nlohmann::json::array();
    json_.push_back(ToJson(*value));
  }
  template <typename Index, typename Item>
  void Id(const char* name, const Index* index, std::vector<Item> Sequence::*items,
          const char* doc) {
    std::optional<int> id = *index;
    if (id && sequence_ != nullptr) id = (sequence_->*items).at(*id).id;
    Field(name, &id, doc);
  }
  void FrameIdItem(const int* index, const char* doc) {
    Item(&sequence_->frames.at(*index).id, doc);
  }
  void OfSequence(const Sequence* sequence) { sequence_ = sequence; }
  const Sequence* sequence() const { return sequence_; }
  nlohmann::json Take() { return std::move(json_); }

  template <typename Value>
  static bool IsAbsent(const Value& value) {
    if constexpr (internal::kIs<std::optional, Value>) {
      return !value.has_value();
    } else if constexpr (internal::kIs<std::vector, Value> || internal::kIs<std::map, Value>) {
      return value.empty();
    } else {
      return value == Value();
    }
  }

  template <typename Value, typename Describer = ByDescribe>
  nlohmann::json ToJson(const Value& value, const Describer& describe = {}) const {
    using nlohmann::json;
    if constexpr (std::same_as<Value, json> || std::is_arithmetic_v<Value> ||
                  internal::IsMatrix<Value>) {
      return value;
    } else if constexpr (internal::IsText<Value>) {
      return std::string(value);
    } else if constexpr (std::is_enum_v<Value>) {
      return NameOf(value);
    } else if constexpr (internal::kIs<std::optional, Value>) {
      return value ? ToJson(*value, describe) : json();
    } else if constexpr (internal::kIs<std::vector, Value> || internal::kIsArray<Value>) {
      json list = json::array();
      for (const auto& item : value) list.push_back(ToJson(item, describe));
      return list;
    } else if constexpr (internal::kIs<std::map, Value>) {
      json object = json::object();
      for (const auto& [key, item] : value) {
        object[ToJson(key).template get<std::string>()] = ToJson(item, describe);
      }
      return object;
    } else if constexpr (std::same_as<Value, Eigen::Quaterniond>) {
      return {value.x(), value.y(), value.z(), value.w()};
    } else {
      JsonWriter part(sequence_);
      // Descriptions change what they visit only when it is read.
      describe(part, const_cast<Value&>(value));
      return part.Take();
    }
  }

 private:
  const Sequence* sequence_;
  nlohmann::json json_ = nlohmann::json::object();
};

// Reads one struct, and refuses what its description does not allow: InputError with the place,
// what was found and what was expected.
class JsonReader {
 public:
  JsonReader(const nlohmann::json& json, const Place& place, const Sequence* sequence)
      : json_(json), place_(place), sequence_(sequence) {}

  template <typename Value, typename Describer = ByDescribe>
  void Field(const char* name, Value* value, const char* /*doc*/, const Limits& limits = {},
             const Describer& describe = {}) {
    names_.push_back(name);
    Read(internal::RequireField(json_, name, place_), Place(place_, name), limits, describe, value);
  }
  template <typename Value, typename Describer = ByDescribe>
  void OrNull(const char* name, Value* value, const char* doc, const Limits& limits = {},
              const Describer& describe = {}) {
    std::optional<Value> read;
    Field(name, &read, doc, limits, describe);
    *value = read.value_or(Value());
  }
  template <typename Value, typename Describer = ByDescribe>
  void OrAbsent(const char* name, Value* value, const char* doc, const Limits& limits = {},
                const Describer& describe = {}) {
    names_.push_back(name);
    internal::CheckIsObject(json_, place_);
    *value = Value();
    if (json_.contains(name)) Field(name, value, doc, limits, describe);
  }
  template <typename Value>
  void OrDefault(const char* name, Value* value, const Value& absent, const char* doc,
                 const Limits& limits = {}) {
    OrAbsent(name, value, doc, limits);
    if (!json_.contains(name)) *value = absent;
  }
  template <typename Value>
  void Unit(const char* name, Value* value, const char* doc) {
    Field(name, value, doc);
    const double norm = value->norm();
    if (!(std::abs(norm - 1.0) <= internal::kUnitTolerance)) {
      internal::Refuse(Place(place_, name), json_[name],
                       fmt::format("a norm of 1, not of {}", norm));
    }
  }
  bool IsText(std::string* text, const char* /*doc*/) {
    if (json_.is_string()) *text = internal::ReadText(json_, kNotEmpty, place_);
    return json_.is_string();
  }
  template <typename Value>
  void Item(Value* value, const char* /*doc*/, const Limits& limits = {}) {
    internal::CheckIsList(json_, items_ + 1, /*is_exact=*/false, place_);
    Read(json_[items_], Place(place_, items_), limits, ByDescribe(), value);
    ++items_;
  }
  template <typename Index, typename Item>
  void Id(const char* name, Index* index, std::vector<Item> Sequence::*items, const char* doc) {
    Field(name, index, doc);
    if (sequence_ == nullptr || json_[name].is_null()) return;
    *index = internal::IndexOfIdAt(Place(place_, name), sequence_->*items, json_[name]);
  }
  void FrameIdItem(int* index, const char* doc) {
    Item(index, doc, kNotNegative);
    if (sequence_ == nullptr) return;
    const size_t item = items_ - 1;
    *index = internal::IndexOfIdAt(Place(place_, item), sequence_->frames, json_[item]);
  }
  template <typename Violation>
  void Check(const Violation& violation) {
    if (const std::string words = violation(); !words.empty()) {
      internal::RefuseInWords(place_, words);
    }
  }

  template <typename Action>
  void AfterReading(const Action& action) {
    action();
  }
  void OfSequence(const Sequence* sequence) { sequence_ = sequence; }
  const Sequence* sequence() const { return sequence_; }

  // Refuses what was not described.
  void Finish() const {
    if (json_.is_array()) internal::CheckIsList(json_, items_, /*is_exact=*/true, place_);
    if (json_.is_object()) internal::RefuseUnknownFields(json_, names_, place_);
  }

  template <typename Value, typename Describer = ByDescribe>
  void Read(const nlohmann::json& json, const Place& place, const Limits& limits,
            const Describer& describe, Value* value) const {
    if constexpr (std::same_as<Value, nlohmann::json>) {
      *value = json;
    } else if constexpr (std::same_as<Value, bool>) {
      *value = internal::ReadTruth(json, place);
    } else if constexpr (std::integral<Value>) {
      static_assert(sizeof(Value) <= sizeof(int),
                    "limits are doubles, which have all such numbers");
      Limits of_type = limits;
      of_type.min = std::max(limits.min, static_cast<double>(std::numeric_limits<Value>::min()));
      of_type.max = std::min(limits.max, static_cast<double>(std::numeric_limits<Value>::max()));
      *value = static_cast<Value>(internal::ReadWholeNumber(json, of_type, place));
    } else if constexpr (std::floating_point<Value>) {
      *value = internal::ReadNumber(json, limits, place);
    } else if constexpr (internal::IsText<Value>) {
      *value = internal::ReadText(json, limits, place);
    } else if constexpr (std::is_enum_v<Value>) {
      *value = static_cast<Value>(internal::ReadName(json, NamesOf(Value()), place));
    } else if constexpr (internal::kIs<std::optional, Value>) {
      value->reset();
      if (json.is_null()) return;
      typename Value::value_type read = {};
      Read(json, place, limits, describe, &read);
      *value = std::move(read);
    } else if constexpr (internal::kIs<std::vector, Value> || internal::kIsArray<Value>) {
      if constexpr (internal::kIsArray<Value>) {
        internal::CheckIsList(json, value->size(), /*is_exact=*/true, place);
      } else {
        internal::CheckIsList(json, limits.least_items, /*is_exact=*/false, place);
        value->assign(json.size(), {});
      }
      for (size_t i = 0; i < json.size(); ++i) {
        Read(json[i], Place(place, i), limits, describe, &(*value)[i]);
      }
    } else if constexpr (internal::kIs<std::map, Value>) {
      internal::CheckIsObject(json, place);
      value->clear();
      for (const auto& item : json.items()) {
        typename Value::key_type key;
        Read(item.key(), place, {}, describe, &key);
        Read(item.value(), Place(place, item.key()), limits, describe, &(*value)[key]);
      }
    } else if constexpr (std::same_as<Value, Eigen::Quaterniond>) {
      Read(json, place, limits, describe, &value->coeffs());
    } else if constexpr (internal::IsMatrix<Value>) {
      internal::CheckIsList(json, value->rows(), /*is_exact=*/true, place);
      for (int i = 0; i < value->rows(); ++i) {
        const Place row(place, i);
        if constexpr (Value::ColsAtCompileTime == 1) {
          (*value)[i] = internal::ReadNumber(json[i], limits, row);
        } else {
          internal::CheckIsList(json[i], value->cols(), /*is_exact=*/true, row);
          for (int k = 0; k < value->cols(); ++k) {
            (*value)(i, k) = internal::ReadNumber(json[i][k], limits, Place(row, k));
          }
        }
      }
    } else {
      JsonReader part(json, place, sequence_);
      describe(part, *value);
      part.Finish();
    }
  }

 private:
  const nlohmann::json& json_;
  const Place& place_;
  const Sequence* sequence_;
  std::vector<std::string_view> names_;
  size_t items_ = 0;
};

// The JSON schema (draft 7) of one struct.
class SchemaWriter : public internal::VisitorThatDoesNotRead {
 public:
  template <typename Value, typename Describer = ByDescribe>
  void Field(const char* name, Value* /*value*/, const char* doc, const Limits& limits = {},
             const Describer& describe = {}) {
    required_.push_back(name);
    Add(name, doc, Of<Value>(limits, describe));
  }
  template <typename Value, typename Describer = ByDescribe>
  void OrNull(const char* name, Value* /*value*/, const char* doc, const Limits& limits = {},
              const Describer& describe = {}) {
    required_.push_back(name);
    Add(name, doc, internal::OrNullSchema(Of<Value>(limits, describe)));
  }
  template <typename Value, typename Describer = ByDescribe>
  void OrAbsent(const char* name, Value* /*value*/, const char* doc, const Limits& limits = {},
                const Describer& describe = {}) {
    Add(name, doc, Of<Value>(limits, describe));
    if constexpr (!internal::kIs<std::optional, Value>) {
      properties_[name]["default"] = JsonWriter(nullptr).ToJson(Value(), describe);
    }
  }
  template <typename Value>
  void OrDefault(const char* name, Value* /*value*/, const Value& absent, const char* doc,
                 const Limits& limits = {}) {
    Add(name, doc, Of<Value>(limits));
    properties_[name]["default"] = JsonWriter(nullptr).ToJson(absent);
  }
  template <typename Value>
  void Unit(const char* name, Value* value, const char* doc) {
    Field(name, value, doc);
  }
  bool IsText(std::string* /*text*/, const char* doc) {
    text_ = {{"description", doc}, {"type", "string"}, {"minLength", 1}};
    return false;
  }
  template <typename Value>
  void Item(Value* /*value*/, const char* doc, const Limits& limits = {}) {
    items_.push_back({{"description", doc}});
    items_.back().update(Of<Value>(limits));
  }
  template <typename Index, typename Item>
  void Id(const char* name, Index* index, std::vector<Item> Sequence::*, const char* doc) {
    Field(name, index, doc);
  }
  void FrameIdItem(int* index, const char* doc) { Item(index, doc, kNotNegative); }
  void OfSequence(const Sequence* /*sequence*/) {}
  const Sequence* sequence() const { return nullptr; }
  internal::Schema Take();

  template <typename Value, typename Describer = ByDescribe>
  static internal::Schema Of(const Limits& limits = {}, const Describer& describe = {}) {
    using internal::Schema;
    if constexpr (std::same_as<Value, nlohmann::json>) {
      return Schema::object();
    } else if constexpr (std::same_as<Value, bool>) {
      return {{"type", "boolean"}};
    } else if constexpr (std::is_arithmetic_v<Value>) {
      return internal::NumberSchema(std::integral<Value> ? "integer" : "number", limits);
    } else if constexpr (internal::IsText<Value>) {
      Schema schema = {{"type", "string"}};
      if (limits.min > 0.0) schema["minLength"] = static_cast<int>(limits.min);
      return schema;
    } else if constexpr (std::is_enum_v<Value>) {
      const std::span<const char* const> names = NamesOf(Value());
      return {{"enum", std::vector<std::string>(names.begin(), names.end())}};
    } else if constexpr (internal::kIs<std::optional, Value>) {
      return internal::OrNullSchema(Of<typename Value::value_type>(limits, describe));
    } else if constexpr (internal::kIs<std::vector, Value>) {
      constexpr size_t kAny = std::numeric_limits<size_t>::max();
      return internal::ListSchema(Of<typename Value::value_type>(limits, describe),
                                  limits.least_items, kAny);
    } else if constexpr (internal::kIsArray<Value>) {
      constexpr size_t kSize = std::tuple_size_v<Value>;
      return internal::ListSchema(Of<typename Value::value_type>(limits, describe), kSize, kSize);
    } else if constexpr (internal::kIs<std::map, Value>) {
      return {{"type", "object"},
              {"additionalProperties", Of<typename Value::mapped_type>(limits, describe)}};
    } else if constexpr (std::same_as<Value, Eigen::Quaterniond>) {
      return Of<Eigen::Vector4d>(limits);
    } else if constexpr (internal::IsMatrix<Value>) {
      constexpr size_t kRows = Value::RowsAtCompileTime, kColumns = Value::ColsAtCompileTime;
      const Schema number = internal::NumberSchema("number", limits);
      return internal::ListSchema(
          kColumns == 1 ? number : internal::ListSchema(number, kColumns, kColumns), kRows, kRows);
    } else {
      SchemaWriter part;
      Value value = {};
      describe(part, value);
      return part.Take();
    }
  }

 private:
  void Add(const char* name, const char* doc, const internal::Schema& schema) {
    properties_[name] = {{"description", doc}};
    properties_[name].update(schema);
  }

  std::vector<std::string> required_;
  internal::Schema properties_ = internal::Schema::object();
  internal::Schema items_ = internal::Schema::array();
  internal::Schema text_;
};

// `sequence`: the one that frames, objects and planes belong to.
template <typename Value>
nlohmann::json DescribedToJson(const Value& value, const Sequence* sequence = nullptr) {
  return JsonWriter(sequence).ToJson(value);
}

// Throws InputError, see JsonReader. Without a sequence, the indices of frames, objects and planes
// are their ids.
template <typename Value>
Value DescribedFromJson(const nlohmann::json& json, const Sequence* sequence = nullptr) {
  Value value = {};
  const Place root;
  JsonReader(json, root, sequence).Read(json, root, {}, ByDescribe(), &value);
  return value;
}

}  // namespace soslam
