// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/header_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace kinfer {
namespace {

struct Word {
  std::string_view text;
  ChannelKind kind;
};

// Longer words first: "linearacceleration" holds "acceleration".
constexpr std::array instrument_words{
    Word{"magneticfield", ChannelKind::field},
    Word{"magnetometer", ChannelKind::field},
    Word{"accelerometer", ChannelKind::force},
    Word{"acceleration", ChannelKind::force},
    Word{"specificforce", ChannelKind::force},
    Word{"angularvelocity", ChannelKind::rate},
    Word{"angularrate", ChannelKind::rate},
    Word{"turnrate", ChannelKind::rate},
    Word{"gyroscope", ChannelKind::rate},
    Word{"calibratedacc", ChannelKind::force},
    Word{"accel", ChannelKind::force},
    Word{"gyro", ChannelKind::rate},
    Word{"magn", ChannelKind::field},
    Word{"acc", ChannelKind::force},
    Word{"gyr", ChannelKind::rate},
    Word{"mag", ChannelKind::field},
};
constexpr std::array free_words{"linear", "free", "user", "dynamic", "withoutgravity", "withoutg", "nogravity"};
constexpr std::array time_words{"t",           "time",      "timestamp", "sampletimefine", "secondselapsed",
                                "elapsedtime", "timeinsec", "seconds",   "times",          "systemtime"};
// Derived quantities that hold an instrument's word.
constexpr std::array other_words{"bias",   "temp",  "norm", "abs",   "std",
                                 "status", "range", "clip", "delta", "uncalibrated_bias"};

/// Lower case, letters and digits only.
std::string simplified(std::string_view name) {
  std::string text;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool holds(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

/// Our own short channels: "boom_gx".
std::optional<GuessedColumn> own_channel(std::string_view name) {
  constexpr std::string_view letters = "agm";
  if (name.size() < 2) return std::nullopt;
  const std::string_view channel = name.substr(name.size() - 2);
  const auto at = letters.find(channel[0]);
  const bool is_separate = name.size() == 2 || (name.size() > 3 && name[name.size() - 3] == '_');
  if (!is_separate || at == std::string_view::npos || channel[1] < 'x' || channel[1] > 'z') return std::nullopt;
  constexpr std::array kinds{ChannelKind::force, ChannelKind::rate, ChannelKind::field};
  return GuessedColumn{kinds[at], static_cast<std::size_t>(channel[1] - 'x'),
                       std::string(name.size() == 2 ? "" : name.substr(0, name.size() - 3))};
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view separators = " _-.:/";
  const auto first = text.find_first_not_of(separators);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(separators) - first + 1);
}

/// Position of a word in the name that ignores case and separators; the name's part before it names the sensor.
std::string sensor_before(std::string_view name, std::string_view word) {
  for (std::size_t end = 0; end <= name.size(); ++end)
    if (simplified(name.substr(end)).starts_with(word) &&
        (end == name.size() || std::isalnum(static_cast<unsigned char>(name[end]))))
      return std::string(trimmed(name.substr(0, end)));
  return {};
}

}  // namespace

GuessedColumn guess_column(std::string_view name) {
  const std::string text = simplified(name);
  if (std::ranges::find(time_words, text) != time_words.end()) return {ChannelKind::time, 0, {}};
  if (const auto own = own_channel(name)) return *own;
  if (text.size() < 4 || std::ranges::any_of(other_words, [&](const char* w) { return holds(text, w); })) return {};
  const auto word = std::ranges::find_if(instrument_words, [&](const Word& w) { return holds(text, w.text); });
  if (word == instrument_words.end()) return {};
  const bool axis_first = text.front() >= 'x' && text.front() <= 'z' && text.substr(1).starts_with(word->text);
  const char axis = axis_first ? text.front() : text.back();
  if (axis < 'x' || axis > 'z') return {};
  const bool is_free = word->kind == ChannelKind::force &&
                       std::ranges::any_of(free_words, [&](const char* w) { return holds(text, w); });
  return {is_free ? ChannelKind::free_acceleration : word->kind, static_cast<std::size_t>(axis - 'x'),
          axis_first || is_free ? std::string() : sensor_before(name, word->text)};
}

}  // namespace kinfer
