#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

namespace thermovox::test {

/// What is wrong with the tags: every element is closed, in the right order; those of HTML that have no end
/// and those of SVG that close themselves apart.
[[nodiscard]] inline std::string faultOfTags(const std::string& html) {
  const std::set<std::string> kVoid{"meta", "link", "br"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return "a tag that does not end";
    const std::string tag = html.substr(at + 1, end - at - 1);
    if (tag.starts_with('!') || tag.ends_with('/')) continue;
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) return "</" + tag.substr(1) + "> closes nothing";
      open.pop_back();
    } else if (const std::string name = tag.substr(0, tag.find(' ')); !kVoid.contains(name)) {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

/// How often a part occurs.
[[nodiscard]] inline std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Tags close, links lead somewhere, nothing is fetched or run.
inline void expectSound(const std::string& html) {
  EXPECT_EQ(faultOfTags(html), "");
  std::set<std::string> ids;
  const std::regex id_text(" id=\"([^\"]+)\""), link_text(" href=\"#([^\"]+)\"");
  for (std::sregex_iterator i(html.begin(), html.end(), id_text), end; i != end; ++i) {
    EXPECT_TRUE(ids.insert((*i)[1]).second) << "twice: " << (*i)[1];
  }
  for (std::sregex_iterator i(html.begin(), html.end(), link_text), end; i != end; ++i) {
    EXPECT_TRUE(ids.contains((*i)[1])) << "leads nowhere: #" << (*i)[1];
  }
  for (const char* fetched :
       {"src=\"http", "href=\"http", "url(", "@import", "<script", "<iframe", "<object"}) {
    EXPECT_THAT(html, testing::Not(testing::HasSubstr(fetched)));
  }
}

}  // namespace thermovox::test
