// The documents against the source: names of equations, functions, names of results, links, length.
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

// The names in brackets that stand at the end of a line in a fenced block.
std::vector<std::string> equation_names(const std::string& markdown) {
  static const std::regex named(R"(\s\[(\w+)\]\s*$)");
  std::vector<std::string> names;
  bool fenced = false;
  for (const std::string& line : lines_of(markdown)) {
    if (line.starts_with("```")) fenced = !fenced;
    std::smatch match;
    if (fenced && std::regex_search(line, match, named)) names.push_back(match[1]);
  }
  return names;
}

// Names that two equations have.
std::vector<std::string> name_faults(const std::string& markdown) {
  std::vector<std::string> faults;
  std::set<std::string> before;
  for (const std::string& name : equation_names(markdown))
    if (!before.insert(name).second) faults.push_back("two equations are named [" + name + "]");
  return faults;
}

// Citations such as `theory.md [central], [first_step]` of equations that are not there, or by
// number.
std::vector<std::string> citation_faults(const std::vector<Text>& files,
                                         const std::string& theory) {
  static const std::regex cited(R"(theory\.md,?(?: below)? ((?:\[\w+\](?:, | and )?)+))");
  static const std::regex numbered(R"(theory\.md,?(?: below)? (\(\d+\w?\)))");
  static const std::regex name(R"(\[(\w+)\])");
  const std::vector<std::string> there = equation_names(theory);
  std::vector<std::string> faults;
  for (const Text& file : files) {
    for (const std::string& list : all_of(file.text, cited))
      for (const std::string& one : all_of(list, name))
        if (std::find(there.begin(), there.end(), one) == there.end())
          faults.push_back(file.path + ": theory.md has no equation [" + one + "]");
    for (const std::string& number : all_of(file.text, numbered))
      faults.push_back(file.path + ": equations of theory.md have names, not " + number);
  }
  return faults;
}

// Names in documents, `[name]` in back-quotes, that neither an equation has nor a table of a
// scenario, which begins a line of some document or is a heading.
std::vector<std::string> bracket_faults(const std::vector<Text>& files, const std::string& theory) {
  static const std::regex quoted(R"(`\[([a-z0-9_]+)\]`)");
  static const std::regex table(R"(\n(?:## `)?\[(\w+)\])");
  std::set<std::string> known;
  for (const std::string& name : equation_names(theory)) known.insert(name);
  for (const Text& file : files)
    for (const std::string& name : all_of(file.text, table)) known.insert(name);
  std::vector<std::string> faults;
  for (const Text& file : files)
    for (const std::string& name : all_of(file.text, quoted))
      if (!known.contains(name))
        faults.push_back(file.path + ": there is no equation and no table [" + name + "]");
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

TEST(Docs, EveryEquationHasANameOfItsOwn) {
  const std::string theory = read("docs/theory.md").text;
  EXPECT_GE(equation_names(theory).size(), 30U);
  EXPECT_EQ(joined(name_faults(theory)), "");
}

TEST(Docs, EveryEquationThatTheSourceOrADocumentCitesIsThere) {
  const std::string theory = read("docs/theory.md").text;
  EXPECT_EQ(joined(citation_faults(source(), theory)), "");
  EXPECT_EQ(joined(bracket_faults(documents(), theory)), "");
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
    "Force [c].\n```\nF = k u    [spring]\nm a = F\nf [c] = 0  [rest]\n```\n";
const std::vector<Text> made_up_source{
    {"src/contact/hertz.cpp", "namespace hertz {\ndouble force(double depth) {}\n}\n"}};

TEST(DocsCheck, ReadsNamesAtTheEndOfFencedLinesOnly) {
  EXPECT_EQ(equation_names(made_up_theory), (std::vector<std::string>{"spring", "rest"}));
  EXPECT_EQ(joined(name_faults(made_up_theory)), "");
  EXPECT_EQ(joined(name_faults("```\na [one]\nb [one]\n```\n")), "two equations are named [one]\n");
}

TEST(DocsCheck, CatchesACitationOfNothing) {
  const auto faults = [](const std::string& comment) {
    return joined(citation_faults({{"src/a.cpp", comment}}, made_up_theory));
  };
  EXPECT_EQ(
      faults("// F = k u; docs/theory.md [spring]\n// theory.md [spring], [rest]\n// x [c]\n"), "");
  EXPECT_EQ(faults("// docs/theory.md [c]\n"), "src/a.cpp: theory.md has no equation [c]\n");
  EXPECT_EQ(faults("// theory.md, below [rest], [c]\n"),
            "src/a.cpp: theory.md has no equation [c]\n");
  EXPECT_EQ(faults("// theory.md (12a).\n"),
            "src/a.cpp: equations of theory.md have names, not (12a)\n");
}

TEST(DocsCheck, CatchesANameInADocumentThatIsNeitherEquationNorTable) {
  const std::vector<Text> pages{
      {"docs/a.md", "See `[spring]`, `[tissue]`, `[sweep]` and `[c]`.\n```\n[tissue]\n```\n"},
      {"docs/b.md", "# B\n## `[sweep]`\n"}};
  EXPECT_EQ(joined(bracket_faults(pages, made_up_theory)),
            "docs/a.md: there is no equation and no table [c]\n");
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
      "record.findings.push_back({\"energy_imbalance\", 0.0});\nwarning(\"deep\");\n";
  EXPECT_EQ(result_names(made_up),
            (std::set<std::string>{"case", "energy_imbalance", "force_N", "nodes"}));
  EXPECT_EQ(joined(unnamed(result_names(made_up), "`case`, `nodes`, force_N, `energy_imbalance`")),
            "force_N\n");
}

}  // namespace
