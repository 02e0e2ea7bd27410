// The documents against the source: equation numbers, functions, names of results, links, length.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_readme = 119;  // lines: under 120

struct Text {
  std::string path;  // below the project's top, with `/`
  std::string text;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Every first group of a pattern, in the order of the text.
std::vector<std::string> all_of(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    found.push_back((*at)[1].str());
  return found;
}

std::string joined(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += fault + "\n";
  return text;
}

// The numbers that stand at the end of a line in a fenced block.
std::vector<int> equation_numbers(const std::string& markdown) {
  static const std::regex numbered(R"(\s\((\d+)\)\s*$)");
  std::vector<int> numbers;
  bool fenced = false;
  for (const std::string& line : lines_of(markdown)) {
    if (line.starts_with("```")) fenced = !fenced;
    std::smatch match;
    if (fenced && std::regex_search(line, match, numbered)) numbers.push_back(std::stoi(match[1]));
  }
  return numbers;
}

// What is wrong with the numbers of a document: they run from 1, each once, in order.
std::vector<std::string> numbering_faults(const std::string& markdown) {
  std::vector<std::string> faults;
  int expected = 1;
  for (const int number : equation_numbers(markdown)) {
    if (number != expected)
      faults.push_back("equation (" + std::to_string(number) + ") stands where (" +
                       std::to_string(expected) + ") should");
    expected = number + 1;
  }
  return faults;
}

// Citations such as `theory.md (38), (39)` or `theory.md (9)-(14)` of equations that are not
// there.
std::vector<std::string> citation_faults(const std::vector<Text>& files,
                                         const std::string& theory) {
  static const std::regex cited(R"(theory\.md ((?:\(\d+\)(?:, |-)?)+))");
  static const std::regex number(R"(\((\d+)\))");
  const std::vector<int> there = equation_numbers(theory);
  std::vector<std::string> faults;
  for (const Text& file : files)
    for (const std::string& list : all_of(file.text, cited))
      for (const std::string& one : all_of(list, number))
        if (std::find(there.begin(), there.end(), std::stoi(one)) == there.end())
          faults.push_back(file.path + ": theory.md has no equation (" + one + ")");
  return faults;
}

bool has_word(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("\\b" + word + "\\b"));
}

// Backquoted `src/...` paths that no file has, and `name::function` after one on the same line that
// the file does not know.
std::vector<std::string> pointer_faults(const Text& document, const std::vector<Text>& files) {
  static const std::regex quoted("`([^`]+)`");
  static const std::regex name(R"([A-Za-z_]\w*(::[A-Za-z_]\w*)+)");
  std::vector<std::string> faults;
  for (const std::string& line : lines_of(document.text)) {
    const Text* beside = nullptr;
    for (const std::string& word : all_of(line, quoted)) {
      if (word.starts_with("src/")) {
        const auto found = std::find_if(files.begin(), files.end(),
                                        [&](const Text& file) { return file.path == word; });
        beside = found == files.end() ? nullptr : &*found;
        if (beside == nullptr)
          faults.push_back(document.path + ": there is no file `" + word + "`");
      } else if (beside != nullptr && std::regex_match(word, name)) {
        for (const std::string& part : all_of(word, std::regex(R"((\w+))")))
          if (!has_word(beside->text, part))
            faults.push_back(document.path + ": `" + beside->path + "` has no `" + part + "` of `" +
                             word + "`");
      }
    }
  }
  return faults;
}

// Relative links and pictures whose target is not there; `exists` takes a path below the top.
template <class Exists>
std::vector<std::string> link_faults(const Text& document, const Exists& exists) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> faults;
  for (const std::string& target : all_of(document.text, link)) {
    if (target.starts_with("#") || target.find(':') != std::string::npos) continue;
    const fs::path path =
        fs::path(document.path).parent_path() / target.substr(0, target.find('#'));
    if (!exists(path.lexically_normal().generic_string()))
      faults.push_back(document.path + ": the link to `" + target + "` leads nowhere");
  }
  return faults;
}

// Columns and findings that the source names in these ways:  columns = {"a", ...}  add("a", ...)
// findings.push_back({"a", ...
std::set<std::string> result_names(const std::string& source) {
  static const std::regex columns(R"(columns\s*=\s*\{([^}]*)\})");
  static const std::regex finding(R"re((?:\badd\(|findings\.push_back\(\{)\s*"(\w+)")re");
  static const std::regex word(R"re("(\w+)")re");
  std::set<std::string> names;
  for (const std::string& list : all_of(source, columns))
    for (const std::string& name : all_of(list, word)) names.insert(name);
  for (const std::string& name : all_of(source, finding)) names.insert(name);
  return names;
}

std::vector<std::string> unnamed(const std::set<std::string>& names, const std::string& markdown) {
  const std::vector<std::string> words = all_of(markdown, std::regex("`([^`\n]+)`"));
  std::vector<std::string> missing;
  for (const std::string& name : names)
    if (std::find(words.begin(), words.end(), name) == words.end()) missing.push_back(name);
  return missing;
}

const fs::path top = PALPATE_SOURCE_DIR;

Text read(const std::string& path) {
  const std::ifstream stream(top / path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return {path, text.str()};
}

std::vector<Text> files_below(const std::string& folder, const std::vector<std::string>& endings) {
  std::vector<Text> files;
  for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
    const std::string ending = entry.path().extension().string();
    if (!entry.is_regular_file() ||
        std::find(endings.begin(), endings.end(), ending) == endings.end())
      continue;
    files.push_back(read(entry.path().lexically_relative(top).generic_string()));
  }
  std::sort(files.begin(), files.end(),
            [](const Text& a, const Text& b) { return a.path < b.path; });
  return files;
}

std::vector<Text> source() { return files_below("src", {".h", ".cpp"}); }

std::vector<Text> documents() {
  std::vector<Text> all = files_below("docs", {".md"});
  all.push_back(read("README.md"));
  return all;
}

TEST(Docs, EquationsAreNumberedInOrder) {
  const std::string theory = read("docs/theory.md").text;
  EXPECT_GE(equation_numbers(theory).size(), 30U);
  EXPECT_EQ(joined(numbering_faults(theory)), "");
}

TEST(Docs, EveryNumberThatTheSourceCitesIsThere) {
  EXPECT_EQ(joined(citation_faults(source(), read("docs/theory.md").text)), "");
}

TEST(Docs, EveryFileAndFunctionOfTheTheoryIsThere) {
  EXPECT_EQ(joined(pointer_faults(read("docs/theory.md"), source())), "");
}

TEST(Docs, EveryColumnAndFindingStandsInTheResults) {
  std::set<std::string> names;
  for (const Text& file : source()) {
    const bool tables = file.path.starts_with("src/record/") || file.path.starts_with("src/fit/") ||
                        file.path.starts_with("src/run/") || file.path.starts_with("src/report/");
    if (tables) names.merge(result_names(file.text));
  }
  EXPECT_GE(names.size(), 50U) << "the source names its columns and findings in another way now";
  EXPECT_EQ(joined(unnamed(names, read("docs/results.md").text)), "");
}

TEST(Docs, EveryRelativeLinkLeadsToAFile) {
  for (const Text& document : documents())
    EXPECT_EQ(joined(link_faults(document,
                                 [](const std::string& path) { return fs::exists(top / path); })),
              "");
}

TEST(Docs, ReadmeIsShort) {
  const std::size_t lines = lines_of(read("README.md").text).size();
  EXPECT_GT(lines, 0U);
  EXPECT_LE(lines, longest_readme);
}

// The checks themselves, on made-up texts: each fault is found, and nothing else is.
const std::string made_up_theory =
    "Force (7).\n```\nF = k u    (1)\nm a = F\nf (3) = 0  (2)\n```\n";
const std::vector<Text> made_up_source{
    {"src/contact/hertz.cpp", "namespace hertz {\ndouble force(double depth) {}\n}\n"}};

TEST(DocsCheck, ReadsNumbersAtTheEndOfFencedLinesOnly) {
  EXPECT_EQ(equation_numbers(made_up_theory), (std::vector<int>{1, 2}));
  EXPECT_EQ(joined(numbering_faults(made_up_theory)), "");
  EXPECT_EQ(joined(numbering_faults("```\na (1)\nb (1)\n```\n")),
            "equation (1) stands where (2) should\n");
  EXPECT_EQ(joined(numbering_faults("```\na (1)\nb (3)\n```\n")),
            "equation (3) stands where (2) should\n");
}

TEST(DocsCheck, CatchesACitationOfNothing) {
  const auto faults = [](const std::string& comment) {
    return joined(citation_faults({{"src/a.cpp", comment}}, made_up_theory));
  };
  EXPECT_EQ(faults("// F = k u; docs/theory.md (1)\n// theory.md (1), (2)\n// eq. (9)\n"), "");
  EXPECT_EQ(faults("// docs/theory.md (3)\n"), "src/a.cpp: theory.md has no equation (3)\n");
  EXPECT_EQ(faults("// docs/theory.md (2), (4)\n"), "src/a.cpp: theory.md has no equation (4)\n");
  EXPECT_EQ(faults("// theory.md (1)-(5).\n"), "src/a.cpp: theory.md has no equation (5)\n");
}

TEST(DocsCheck, CatchesAFileOrFunctionThatIsGone) {
  const auto faults = [](const std::string& line) {
    return joined(pointer_faults({"docs/theory.md", line}, made_up_source));
  };
  EXPECT_EQ(faults("`src/contact/hertz.cpp`: `hertz::force`, `k_e`, and `std::sqrt` elsewhere"),
            "docs/theory.md: `src/contact/hertz.cpp` has no `std` of `std::sqrt`\n"
            "docs/theory.md: `src/contact/hertz.cpp` has no `sqrt` of `std::sqrt`\n");
  EXPECT_EQ(faults("`src/contact/hertz.cpp`: `hertz::force`, `depth = 3`"), "");
  EXPECT_EQ(faults("`std::sqrt` before `src/contact/hertz.cpp`"), "");
  EXPECT_EQ(faults("`src/contact/hertz.cpp`: `hertz::forc`"),
            "docs/theory.md: `src/contact/hertz.cpp` has no `forc` of `hertz::forc`\n");
  EXPECT_EQ(faults("`src/contact/jkr.cpp`: `jkr::force`"),
            "docs/theory.md: there is no file `src/contact/jkr.cpp`\n");
}

TEST(DocsCheck, CatchesALinkThatLeadsNowhere) {
  const auto exists = [](const std::string& path) {
    return path == "docs/paper.md" || path == "README.md";
  };
  const auto faults = [&](const std::string& path, const std::string& text) {
    return joined(link_faults(Text{path, text}, exists));
  };
  EXPECT_EQ(faults("README.md", "[a](docs/paper.md#tables) [b](https://x.org/y) [c](#here)"), "");
  EXPECT_EQ(faults("docs/a.md", "[a](paper.md) [b](../README.md)"), "");
  EXPECT_EQ(faults("docs/a.md", "![a](docs/paper.md)"),
            "docs/a.md: the link to `docs/paper.md` leads nowhere\n");
}

TEST(DocsCheck, CatchesAResultWithoutAWord) {
  const std::string made_up =
      "table.columns = {\"case\",\n  \"force_N\"};\nadd(\"nodes\", 3.0);\n"
      "record.findings.push_back({\"energy_imbalance\", 0.0});\nremark(\"deep\");\n";
  EXPECT_EQ(result_names(made_up),
            (std::set<std::string>{"case", "energy_imbalance", "force_N", "nodes"}));
  EXPECT_EQ(joined(unnamed(result_names(made_up), "`case`, `nodes`, force_N, `energy_imbalance`")),
            "force_N\n");
}

}  // namespace
