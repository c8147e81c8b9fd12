// SPDX-License-Identifier: Apache-2.0
// The two reports and their shared parts. Each function takes the parsed evidence.json and returns HTML.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinfer/report/parts/html.hpp"

namespace kinfer::pages {

/// Content of a report, between the page's head and its scripts.
struct Page {
  std::string title;  ///< of the document
  std::string first;  ///< the first screen
  std::vector<html::Section> sections;
};
Page calibration(const nlohmann::json& evidence);
Page identification(const nlohmann::json& evidence);

// Shared by both reports.
std::string verdict_block(const nlohmann::json& evidence, const std::string& what);
std::string cards(const std::vector<std::pair<std::string, std::string>>& title_and_body);
std::string advice_list(const nlohmann::json& evidence, std::size_t most);
html::Section next_section(const nlohmann::json& evidence);
html::Section repeat_section(const nlohmann::json& evidence);
html::Section glossary_section(const std::vector<std::pair<std::string, std::string>>& word_and_meaning);
/// Cost against generation, best and median.
std::string convergence_plot(const nlohmann::json& best, const nlohmann::json& median, const std::string& subject);

std::vector<double> numbers(const nlohmann::json& list);  ///< null becomes NaN
/// Member of an object; an empty object if missing (evidence of an older kinfer).
const nlohmann::json& member(const nlohmann::json& object, const char* key);
std::string string_at(const nlohmann::json& object, const char* key, const std::string& otherwise = "");

}  // namespace kinfer::pages
