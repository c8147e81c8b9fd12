// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <map>
#include <vector>

#include "kinfer/io/robot_log/message_definition.hpp"

namespace kinfer {
namespace {

constexpr std::string_view written_magic("\x89MCAP0\r\n", 8);
constexpr std::size_t chunk_size = std::size_t{1} << 20;

/// A record's content, built up field by field.
class RecordContent {
 public:
  template <class T>
  RecordContent& number(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  RecordContent& block(std::string_view bytes) { return number(static_cast<std::uint32_t>(bytes.size())).raw(bytes); }
  RecordContent& raw(std::string_view bytes) {
    text_.append(bytes);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void append_record(std::string& to, std::uint8_t opcode, const RecordContent& content) {
  RecordContent head;
  head.number(opcode).number(static_cast<std::uint64_t>(content.text().size()));
  to += head.text() + content.text();
}

/// "sensor_msgs/Imu" → "sensor_msgs/msg/Imu"
std::string ros2_type_name(std::string_view type) {
  const std::size_t slash = type.find('/');
  return std::string(type.substr(0, slash)) + "/msg" + std::string(type.substr(slash));
}

}  // namespace

template <class T>
void CdrMessage::append(T value) {
  constexpr std::size_t encapsulation = 4;
  bytes_.append((sizeof(T) - (bytes_.size() - encapsulation) % sizeof(T)) % sizeof(T), '\0');
  RecordContent content;
  content.number(value);
  bytes_ += content.text();
}

CdrMessage& CdrMessage::time(std::int64_t nanoseconds) {
  constexpr std::int64_t second = 1'000'000'000;
  std::int64_t seconds = nanoseconds / second, rest = nanoseconds % second;
  if (rest < 0) seconds -= 1, rest += second;
  append(static_cast<std::int32_t>(seconds));
  append(static_cast<std::uint32_t>(rest));
  return *this;
}

CdrMessage& CdrMessage::text(std::string_view text) {
  append(static_cast<std::uint32_t>(text.size() + 1));
  bytes_.append(text).push_back('\0');
  return *this;
}

CdrMessage& CdrMessage::number(double value) {
  append(value);
  return *this;
}

CdrMessage& CdrMessage::count(std::uint32_t value) {
  append(value);
  return *this;
}

class McapWriter::State {
 public:
  State(std::ofstream file, std::string name) : file_(std::move(file)), name_(std::move(name)) {
    std::string begin(written_magic);
    append_record(begin, 0x01, RecordContent().block("ros2").block("kinfer"));
    put(begin);
  }

  std::uint16_t add_channel(std::string_view topic, std::string_view type) {
    auto schema = schemas_.find(std::string(type));
    if (schema == schemas_.end()) {
      const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
      schema = schemas_.emplace(std::string(type), id).first;
      RecordContent content;
      content.number(id).block(ros2_type_name(type)).block("ros2msg").block(common_message_definition(type));
      append_record(declarations_, 0x03, content);
    }
    const auto id = static_cast<std::uint16_t>(counts_.size());
    counts_.push_back(0);
    RecordContent content;
    content.number(id).number(schema->second).block(topic).block("cdr").number(std::uint32_t{0});
    append_record(declarations_, 0x04, content);
    return id;
  }

  void write(std::uint16_t channel, std::int64_t time, std::string_view message) {
    if (chunk_.empty() && offsets_.empty()) {
      chunk_begin_ = time;
      if (chunks_.empty()) begin_ = time, chunk_ = declarations_;
    }
    const auto stamp = static_cast<std::uint64_t>(time);
    offsets_[channel].emplace_back(stamp, chunk_.size());
    RecordContent content;
    content.number(channel).number(counts_[channel]++).number(stamp).number(stamp).raw(message);
    append_record(chunk_, 0x05, content);
    chunk_end_ = time;
    if (chunk_.size() >= chunk_size) flush();
  }

  Result<void> finish() {
    if (offsets_.empty() && chunks_.empty()) put(declarations_);
    flush();
    std::string end;
    append_record(end, 0x0F, RecordContent().number(std::uint32_t{0}));
    put(end);
    const std::uint64_t summary = at_;
    std::string text = declarations_ + chunk_index();
    append_record(text, 0x0B, statistics());
    append_record(text, 0x02, RecordContent().number(summary).number(std::uint64_t{0}).number(std::uint32_t{0}));
    put(text + std::string(written_magic));
    file_.flush();
    if (!file_) return error("{}: the file cannot be written (is the disk full?)", name_);
    return {};
  }

 private:
  struct Chunk {
    std::uint64_t begin, end, offset, length, index_length, packed, unpacked;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };

  void put(const std::string& bytes) {
    file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    at_ += bytes.size();
  }

  void flush() {
    if (offsets_.empty()) return;
    std::string packed(ZSTD_compressBound(chunk_.size()), '\0');
    constexpr int level = 3;
    packed.resize(ZSTD_compress(packed.data(), packed.size(), chunk_.data(), chunk_.size(), level));
    Chunk chunk{.begin = static_cast<std::uint64_t>(chunk_begin_),
                .end = static_cast<std::uint64_t>(chunk_end_),
                .offset = at_,
                .length = 0,
                .index_length = 0,
                .packed = packed.size(),
                .unpacked = chunk_.size(),
                .index_offsets = {}};
    RecordContent content;
    content.number(chunk.begin).number(chunk.end).number(chunk.unpacked).number(std::uint32_t{0});
    content.block("zstd").number(chunk.packed).raw(packed);
    std::string text;
    append_record(text, 0x06, content);
    put(text);
    chunk.length = text.size();
    for (const auto& [channel, offsets] : offsets_) {
      chunk.index_offsets[channel] = at_;
      RecordContent list;
      for (const auto& [time, offset] : offsets) list.number(time).number(static_cast<std::uint64_t>(offset));
      std::string index;
      append_record(index, 0x07, RecordContent().number(channel).block(list.text()));
      put(index);
      chunk.index_length += index.size();
    }
    chunks_.push_back(std::move(chunk));
    chunk_.clear();
    offsets_.clear();
  }

  std::string chunk_index() const {
    std::string text;
    for (const Chunk& chunk : chunks_) {
      RecordContent offsets, content;
      for (const auto& [channel, offset] : chunk.index_offsets) offsets.number(channel).number(offset);
      content.number(chunk.begin).number(chunk.end).number(chunk.offset).number(chunk.length).block(offsets.text());
      content.number(chunk.index_length).block("zstd").number(chunk.packed).number(chunk.unpacked);
      append_record(text, 0x08, content);
    }
    return text;
  }

  RecordContent statistics() const {
    std::uint64_t messages = 0;
    RecordContent counts, content;
    for (std::size_t channel = 0; channel < counts_.size(); ++channel) {
      counts.number(static_cast<std::uint16_t>(channel)).number(std::uint64_t{counts_[channel]});
      messages += counts_[channel];
    }
    content.number(messages).number(static_cast<std::uint16_t>(schemas_.size()));
    content.number(static_cast<std::uint32_t>(counts_.size())).number(std::uint32_t{0}).number(std::uint32_t{0});
    content.number(static_cast<std::uint32_t>(chunks_.size())).number(static_cast<std::uint64_t>(begin_));
    content.number(static_cast<std::uint64_t>(chunk_end_)).block(counts.text());
    return content;
  }

  std::ofstream file_;
  std::string name_, declarations_, chunk_;
  std::uint64_t at_ = 0;
  std::map<std::string, std::uint16_t> schemas_;
  std::vector<std::uint32_t> counts_;                                                    // messages of each channel
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::size_t>>> offsets_;  // of the open chunk
  std::int64_t begin_ = 0, chunk_begin_ = 0, chunk_end_ = 0;
  std::vector<Chunk> chunks_;
};

McapWriter::McapWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
McapWriter::~McapWriter() = default;
McapWriter::McapWriter(McapWriter&&) noexcept = default;

Result<McapWriter> McapWriter::create(const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  if (!file) return error("{}: the file cannot be written", path.string());
  return McapWriter(std::make_unique<State>(std::move(file), path.string()));
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::string_view type) {
  return state_->add_channel(topic, type);
}

void McapWriter::write(std::uint16_t channel, std::int64_t time, const CdrMessage& message) {
  state_->write(channel, time, message.bytes());
}

Result<void> McapWriter::finish() {
  return state_->finish();
}

}  // namespace kinfer
