// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/message_decoder.hpp"

#include <algorithm>

namespace kinfer {
namespace {

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::boolean:
    case NumberType::int8:
    case NumberType::uint8:
      return 1;
    case NumberType::int16:
    case NumberType::uint16:
      return 2;
    case NumberType::int32:
    case NumberType::uint32:
    case NumberType::float32:
      return 4;
    case NumberType::int64:
    case NumberType::uint64:
    case NumberType::float64:
      return 8;
  }
  return 1;
}

double read_number(NumberType type, ByteCursor& cursor) {
  switch (type) {
    case NumberType::boolean:
    case NumberType::uint8:
      return cursor.number<std::uint8_t>();
    case NumberType::int8:
      return cursor.number<std::int8_t>();
    case NumberType::int16:
      return cursor.number<std::int16_t>();
    case NumberType::uint16:
      return cursor.number<std::uint16_t>();
    case NumberType::int32:
      return cursor.number<std::int32_t>();
    case NumberType::uint32:
      return cursor.number<std::uint32_t>();
    case NumberType::int64:
      return static_cast<double>(cursor.number<std::int64_t>());
    case NumberType::uint64:
      return static_cast<double>(cursor.number<std::uint64_t>());
    case NumberType::float32:
      return cursor.number<float>();
    case NumberType::float64:
      return cursor.number<double>();
  }
  return 0.0;
}

std::string expected_kind(const WantedField& field) {
  const std::string_view one = field.base == FieldBase::number ? "number"
                               : field.base == FieldBase::time ? "time"
                                                               : "text";
  return field.is_list ? fmt::format("list of {}s", one) : std::string(one);
}

}  // namespace

MessageDecoder::Node MessageDecoder::compile(const MessageField& field, const std::string& prefix, bool is_in_list,
                                             Search& search) {
  const std::string path = prefix + field.name;
  const bool is_list = is_in_list || field.is_array;
  Node node{.base = field.base, .number = field.number, .is_array = field.is_array, .count = field.count};
  if (const auto at = std::ranges::find(search.wanted, path, &WantedField::path); at != search.wanted.end()) {
    node.wanted = static_cast<int>(at - search.wanted.begin());
    node.is_wanted = search.is_found[static_cast<std::size_t>(node.wanted)] = true;
    if (field.base != at->base || is_list != at->is_list) search.misfit = node.wanted;
  }
  for (const MessageField& inside : field.fields) {
    node.fields.push_back(compile(inside, path + ".", is_list, search));
    node.is_wanted |= node.fields.back().is_wanted;
  }
  return node;
}

Result<MessageDecoder> MessageDecoder::make(const LoggedTopic& topic, std::span<const WantedField> wanted) {
  if (topic.serialization == Serialization::other)
    return error("topic {}: its messages are serialised neither by ROS 1 nor by CDR", topic.name);
  const bool is_ros1 = topic.serialization == Serialization::ros1;
  const auto definition = parse_message_definition(topic.definition, topic.type, is_ros1);
  if (!definition) return error("topic {}: {}", topic.name, definition.error().what);
  MessageDecoder decoder;
  decoder.wanted_ = wanted.size();
  decoder.is_aligned_ = !is_ros1;
  Search search{wanted, std::vector<bool>(wanted.size(), false)};
  for (const MessageField& field : *definition) decoder.fields_.push_back(compile(field, "", false, search));
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (!search.is_found[i])
      return error("topic {}: its type {} has no field {}", topic.name, topic.type, wanted[i].path);
  if (search.misfit >= 0) {
    const WantedField& field = wanted[static_cast<std::size_t>(search.misfit)];
    return error("topic {}: field {} of its type {} is no {}", topic.name, field.path, topic.type,
                 expected_kind(field));
  }
  // Nothing behind the last field that is asked for needs to be read.
  while (!decoder.fields_.empty() && !decoder.fields_.back().is_wanted) decoder.fields_.pop_back();
  return decoder;
}

bool MessageDecoder::decode(std::string_view data, std::vector<DecodedField>& found) const {
  found.resize(wanted_);
  for (DecodedField& field : found) field.numbers.clear(), field.texts.clear(), field.times.clear();
  if (is_aligned_) {
    constexpr std::size_t encapsulation = 4;  // alignment is counted from behind it
    if (data.size() < encapsulation || !(data[1] & 1)) return false;
    data.remove_prefix(encapsulation);
  }
  ByteCursor cursor(data);
  read_fields(fields_, cursor, found);
  return cursor.good();
}

void MessageDecoder::read_fields(const std::vector<Node>& nodes, ByteCursor& cursor,
                                 std::vector<DecodedField>& found) const {
  for (const Node& node : nodes) {
    std::size_t count = node.is_array ? node.count : 1;
    if (node.is_array && node.count == 0) {
      if (is_aligned_) cursor.align(4);
      count = cursor.number<std::uint32_t>();
      if (count > cursor.left()) cursor.take(cursor.left() + 1);  // every element takes at least one byte
    }
    if (!cursor.good()) return;
    const bool is_skipped = node.base == FieldBase::number && !node.is_wanted && count > 0;
    if (is_skipped) {
      const std::size_t size = size_of(node.number);
      if (is_aligned_) cursor.align(size);
      cursor.take(count * size);
      continue;
    }
    for (std::size_t i = 0; i < count && cursor.good(); ++i) read_one(node, cursor, found);
  }
}

void MessageDecoder::read_one(const Node& node, ByteCursor& cursor, std::vector<DecodedField>& found) const {
  DecodedField* field = node.wanted >= 0 ? &found[static_cast<std::size_t>(node.wanted)] : nullptr;
  const auto align = [&](std::size_t size) {
    if (is_aligned_) cursor.align(size);
  };
  switch (node.base) {
    case FieldBase::number: {
      align(size_of(node.number));
      const double value = read_number(node.number, cursor);
      if (field) field->numbers.push_back(value);
      return;
    }
    case FieldBase::text: {
      align(4);
      std::string_view text = cursor.block<std::uint32_t>();
      if (is_aligned_ && text.ends_with('\0')) text.remove_suffix(1);
      if (field) field->texts.emplace_back(text);
      return;
    }
    case FieldBase::wide_text: {
      align(4);
      const std::size_t units = cursor.number<std::uint32_t>();
      cursor.take(std::min(units, cursor.left() + 1) * 2);
      return;
    }
    case FieldBase::time: {
      align(4);
      const std::int64_t seconds =
          is_aligned_ ? cursor.number<std::int32_t>() : static_cast<std::int64_t>(cursor.number<std::uint32_t>());
      const std::int64_t nanoseconds = cursor.number<std::uint32_t>();
      if (field) field->times.push_back(seconds * 1'000'000'000 + nanoseconds);
      return;
    }
    case FieldBase::message:
      if (is_aligned_ && node.fields.empty()) cursor.take(1);  // an empty message takes one byte in CDR
      read_fields(node.fields, cursor, found);
      return;
  }
}

}  // namespace kinfer
