// The two reports and what they share. Each function takes evidence.json as parsed and gives a piece of HTML.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinfer/report/html.hpp"

namespace kinfer::pages {

/// A whole report between the page's head and its scripts.
struct Page {
  std::string title;  ///< of the document
  std::string first;  ///< the first screen
  std::vector<html::Section> sections;
};
Page calibration(const nlohmann::json& evidence);
Page identification(const nlohmann::json& evidence);

// What the two share.
std::string verdict_block(const nlohmann::json& evidence, const std::string& what);
std::string cards(const std::vector<std::pair<std::string, std::string>>& title_and_body);
std::string advice_list(const nlohmann::json& evidence, std::size_t most);
html::Section next_section(const nlohmann::json& evidence);
html::Section repeat_section(const nlohmann::json& evidence);
html::Section words_section(const std::vector<std::pair<std::string, std::string>>& word_and_meaning);
/// Cost against generation, best and median.
std::string convergence_plot(const nlohmann::json& best, const nlohmann::json& median, const std::string& of_what);

std::vector<double> numbers(const nlohmann::json& list);  ///< null becomes NaN
/// Of an object; an empty one where evidence of an older kinfer has none.
const nlohmann::json& member(const nlohmann::json& object, const char* key);
std::string text_at(const nlohmann::json& object, const char* key, const std::string& otherwise = "");

}  // namespace kinfer::pages
