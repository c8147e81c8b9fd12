// SPDX-License-Identifier: Apache-2.0
// How evidence.json is written and read: a struct has one function `fields(archive, value)` that names its members, and
// both archives, JsonWriter and JsonReader, call it. Members of the same name and order give the same bytes.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <vector>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::evidence_json {

using Json = nlohmann::ordered_json;

/// The argument of fields(): const where the archive writes.
template <class Archive, class T>
using Value = std::conditional_t<Archive::is_writer, const T, T>;

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t n>
struct IsArray<std::array<T, n>> : std::true_type {};
template <>
struct IsArray<Vec3> : std::true_type {};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

template <class T>
struct IsPair : std::false_type {};
template <class A, class B>
struct IsPair<std::pair<A, B>> : std::true_type {};

}  // namespace kinfer::evidence_json
