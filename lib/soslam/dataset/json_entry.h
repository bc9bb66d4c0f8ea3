// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/json_file.h"

namespace soslam {

// Unknown keys that occur often, and what to write instead.
struct KeyHint {
  std::vector<const char*> keys;
  const char* instead;
};

// Known keys of JSON objects of one kind. All of them are read, or accepted and ignored.
struct KnownKeys {
  std::vector<const char*> keys;
  std::vector<KeyHint> hints = {};
};

class JsonEntry;
// The objects of a list, with places "<place>/<index>". They refer to the list.
std::vector<JsonEntry> ListEntries(const nlohmann::json& list, const std::string& place);

// The vector or matrix of a list of as many numbers or rows as it has; none for anything else.
template <typename Matrix>
std::optional<Matrix> MatrixFromJson(const nlohmann::json& list) {
  try {
    const auto matrix = list.get<Matrix>();
    return nlohmann::json(matrix) == list ? std::optional(matrix) : std::nullopt;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

// Checked access to an object of an external JSON file. It refers to the document, which must
// outlive it. All functions throw InputError, naming place and field, when the field is missing or
// of another type.
class JsonEntry {
 public:
  // `place` is the object's position in error messages: "<file>", "<file>[index]" or "<file>#<JSON
  // pointer>".
  JsonEntry(const nlohmann::json& fields, std::string place);

  const std::string& place() const { return place_; }
  bool Has(const char* name) const { return fields_.contains(name); }

  const nlohmann::json& Field(const char* name) const;
  const nlohmann::json& List(const char* name) const;
  int Integer(const char* name) const;
  double Real(const char* name) const;
  double Positive(const char* name) const;
  bool Flag(const char* name, bool default_value) const;
  std::string Text(const char* name) const;  // not empty
  std::vector<double> Reals(const char* name) const;
  template <int kSize>
  Eigen::Matrix<double, kSize, 1> Vector(const char* name) const {
    const auto vector = MatrixFromJson<Eigen::Matrix<double, kSize, 1>>(Field(name));
    if (!vector) Refuse(name, fmt::format("{} numbers", kSize));
    return *vector;
  }

  [[noreturn]] void Refuse(const char* name, const std::string& expected) const;

  // Refuses keys that are not known, so that none is ignored silently.
  void RefuseUnknownKeys(const KnownKeys& known) const;

 private:
  const nlohmann::json& fields_;
  std::string place_;
};

}  // namespace soslam
