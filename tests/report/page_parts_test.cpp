// SPDX-License-Identifier: Apache-2.0
// Small parts of every page: sentences, cards, sections, the embedded script and style.
#include <gtest/gtest.h>
#include <zlib.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/report/bundle.hpp"
#include "kinfer/report/packed_text.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/verdict_block.hpp"
#include "support/html_text.hpp"

namespace kinfer::report {
namespace {

using test::count_of;
using test::shows;

/// What a browser makes of escaped text.
std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> entities[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}};
  for (const auto& [entity, character] : entities)
    for (auto at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1))
      text.replace(at, std::string(entity).size(), character);
  return text;
}

TEST(Escape, AnyTextComesBackInABrowserAndHoldsNoMarkup) {
  Rng rng(3);
  const std::string alphabet = "<>&\"' abc;#/=äµ°\n";
  for (int trial = 0; trial < 500; ++trial) {
    std::string text;
    for (int i = 0; i < 20; ++i)
      text += alphabet[static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(alphabet.size()) - 0.01))];
    const std::string escaped = html::escape(text);
    EXPECT_EQ(unescaped(escaped), text);
    EXPECT_EQ(escaped.find_first_of("<>\""), std::string::npos) << escaped;
  }
}

TEST(AsSentence, HasACapitalLetterAndTwiceIsOnce) {
  EXPECT_EQ(as_sentence("the tool is off"), "The tool is off");
  EXPECT_EQ(as_sentence("3 joints found"), "3 joints found");
  EXPECT_EQ(as_sentence("µm are small"), "µm are small") << "other bytes are left alone";
  EXPECT_EQ(as_sentence(""), "");
  for (const char* text : {"a", "Z", "to do", "{x}"}) EXPECT_EQ(as_sentence(as_sentence(text)), as_sentence(text));
}

TEST(Cards, AreAnArticleEach) {
  const std::string html = cards({{"First", "<p>one</p>"}, {"Second", "<p>two</p>"}});
  EXPECT_EQ(count_of(html, "<article>"), 2u);
  EXPECT_EQ(count_of(html, "</article>"), 2u);
  EXPECT_LT(html.find("<h2>First</h2><p>one</p>"), html.find("<h2>Second</h2><p>two</p>"));
}

TEST(Section, IsLabelledByItsTitle) {
  const std::string html = html::section({"parameters", "Parameters", "What changed.", "<p>body</p>"});
  EXPECT_TRUE(shows(html, "<section id=\"parameters\" aria-labelledby=\"parameters-title\">"));
  EXPECT_TRUE(shows(html, "<h2 id=\"parameters-title\">Parameters</h2>"));
  EXPECT_EQ(count_of(html, "<section"), count_of(html, "</section>"));
}

TEST(Bundle, TextThatIsPackedComesBack) {
  const std::string text(100000, 'x');
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                     text.size()),
            Z_OK);
  EXPECT_EQ(unpacked_text(std::string_view(packed).substr(0, size), text.size()), text);
}

TEST(Bundle, IsEmbeddedAndFetchesNothing) {
  for (const std::string_view part : {report_script(), report_style()}) {
    EXPECT_EQ(part.find("</script"), std::string_view::npos) << "it would end its own element";
    EXPECT_EQ(part.find("</style"), std::string_view::npos);
    EXPECT_EQ(part.find("@import"), std::string_view::npos);
    EXPECT_EQ(part.find("url(http"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace kinfer::report
