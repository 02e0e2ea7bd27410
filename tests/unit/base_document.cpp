// TOML as a tree with places, settings of the command line, and what is no TOML.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <stdexcept>

#include "base/document.h"
#include "refusal.h"

namespace palpate {
namespace {

std::string refusal(const std::string& text) {
  return test::refusal([&] { return parse_toml(text, "f.toml"); });
}

// The member at a path of keys.
const Member& at(const Node& root, std::initializer_list<const char*> keys) {
  const Node* node = &root;
  const Member* member = nullptr;
  for (const char* key : keys) {
    member = node->find(key);
    if (member == nullptr) throw std::runtime_error(std::string("no key ") + key);
    node = &member->value;
  }
  return *member;
}

void expect_at(const Place& place, int line, int column) {
  EXPECT_EQ(place.text(), (Place{"f.toml", line, column}.text()));
}

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

// The parser calls itself for every level: 25 000 of them, 50 kB, used up the stack.
TEST(Document, IsNotNestedWithoutEnd) {
  const std::string sentence =
      ": this is nested in more than 32 levels; write it as a key of a table, as `tissue.material`";
  const std::string key = repeated("a.", 25'000) + "a";
  EXPECT_EQ(refusal(key + " = 1\n"), "f.toml:1:64" + sentence);
  EXPECT_EQ(refusal("[" + key + "]\n"), "f.toml:1:65" + sentence);
  EXPECT_EQ(refusal("[[" + key + "]]\n"), "f.toml:1:66" + sentence);
  EXPECT_EQ(refusal(repeated("'a'. \"a\" .", 25'000) + "a = 1"), "f.toml:1:160" + sentence);
  EXPECT_EQ(refusal("x = " + repeated("[", 200)), "f.toml:1:37" + sentence);
  EXPECT_EQ(refusal("x = " + repeated("{a=", 200)), "f.toml:1:101" + sentence);
  EXPECT_EQ(test::refusal([&] { return parse_assignment(key + "=1"); }), "--set:1:64" + sentence);
  EXPECT_EQ(test::refusal([&] { return parse_assignment("x={" + key + "=1}"); }),
            "--set x:1:65" + sentence);
  Node root;
  EXPECT_EQ(test::refusal([&] {
              set_value(root, key, Node(), {"sweep", 0, 0});
              return 0;
            }),
            "sweep:1:64" + sentence);
  // Points of numbers, texts and comments are no levels.
  EXPECT_EQ(refusal("a = [" + repeated("1.5, ", 100) + "2]\nb = \"" + repeated("So. ", 100) +
                    "\"\nc = '''" + repeated("[.'\n", 100) + "'''\nd = 1 # " +
                    repeated("...[", 100) + "\n"),
            "accepted");
}

class LineEnds : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Document, LineEnds, testing::Values("\n", "\r\n"));

TEST_P(LineEnds, KeysAndValuesKnowTheirPlaces) {
  std::string text;
  for (const char* line : {"a = 1", "[tissue]", "  material = \"skin\"",
                           "  mesh = { kind = \"kuhn\", cells = [1, 2] }", "[[step]]", "to = 1",
                           "[[step]]", "to   =  2", "[sweep]", "\"a.b\" = [1,", "  2]"})
    text += std::string(line) + GetParam();
  const Node root = parse_toml(text, "f.toml");
  expect_at(at(root, {"a"}).place, 1, 1);
  expect_at(at(root, {"a"}).value.place, 1, 5);
  expect_at(at(root, {"tissue"}).place, 2, 2);
  expect_at(at(root, {"tissue", "material"}).place, 3, 3);
  expect_at(at(root, {"tissue", "material"}).value.place, 3, 14);
  expect_at(at(root, {"tissue", "mesh", "kind"}).place, 4, 12);
  expect_at(at(root, {"tissue", "mesh", "kind"}).value.place, 4, 19);
  expect_at(at(root, {"tissue", "mesh", "cells"}).value.items[1].place, 4, 39);
  const Node& steps = at(root, {"step"}).value;
  ASSERT_EQ(steps.items.size(), 2U);
  expect_at(steps.items[1].place, 7, 1);
  expect_at(at(steps.items[1], {"to"}).value.place, 8, 9);
  expect_at(at(root, {"sweep", "a.b"}).place, 10, 1);
  expect_at(at(root, {"sweep", "a.b"}).value.items[1].place, 11, 3);
}

TEST(Document, ColumnsCountCharactersNotBytes) {
  const Node root = parse_toml("m = { \"\u00b5\u00b5\" = 1, b = 2 }\n", "f.toml");
  expect_at(at(root, {"m", "b"}).place, 1, 17);
}

TEST(Document, AByteOrderMarkIsNotPartOfTheText) {
  expect_at(at(parse_toml("\xef\xbb\xbfx = 1\n", "f.toml"), {"x"}).place, 1, 1);
}

TEST(Document, WhatIsNoTomlIsRefusedAtItsPlace) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "f.toml:1:1: the file is empty; a scenario starts with `schema = 1`"},
      {" \n\t\r\n", "f.toml:1:1: the file is empty; a scenario starts with `schema = 1`"},
      {"a = 1\nb = 2\na = 3\n", "f.toml:3:1: `a` is given twice; keep one of the two"},
      {"a = 1\r\nb = 2\r\n  a = 3\r\n", "f.toml:3:3: `a` is given twice; keep one of the two"},
      {"t = { a = 1, a = 2 }", "f.toml:1:14: `a` is given twice; keep one of the two"},
      {"[a]\nx = 1\n[a]\ny = 1\n", "f.toml:3:1: `[a]` is given twice; keep one of the two"},
      {"a = 1\n[a]\n", "f.toml:2:1: `[a]` is given twice; keep one of the two"},
      {"[sweep]\n\"a.b\"=[1]\n\"a.b\"=[2]\n",
       "f.toml:3:1: `\"a.b\"` is given twice; keep one of the two"},
      {"x = 1\nfriction = 1e400\n",
       "f.toml:2:12: `1e400` is a number that no double can hold; write one between -1e300 and "
       "1e300"},
      {"n = 99999999999999999999\n",
       "f.toml:1:5: `99999999999999999999` is a number that 64 bits cannot hold; write one between "
       "-1e300 and 1e300"},
      {"a = \"skin\nb = 1\n",
       "f.toml:1:10: a text is not closed on its line; end it with the quote it began with"},
      {"a = 'skin",
       "f.toml:1:10: a text is not closed on its line; end it with the quote it began with"},
      {"depth = 5 mm\n",
       "f.toml:1:11: a value is followed by more on its line; put quantities in double quotes, as "
       "`\"5 mm\"`, and each key on a line of its own"},
      {"a = 1\nfriction = 0,35 # of skin\n",
       "f.toml:2:12: `0,35` has a decimal comma; write it with a point, as `0.35`"},
      {"kind = kuhn\n", "f.toml:1:8: this is not a TOML value; put words in double quotes"},
      {"a = 1\nb = \"\xff\"\n", "f.toml:2:6: this is not UTF-8 text; save the file as UTF-8"},
      {"\xc3", "f.toml:1:1: this is not UTF-8 text; save the file as UTF-8"},
      {"# \xc3\xa9 \xe9t\xe9\n", "f.toml:1:5: this is not UTF-8 text; save the file as UTF-8"},
      {std::string("\x7f\x45LF\x02\x00\x00", 7),
       "f.toml:1:1: this is not a text file; give a TOML file"},
      {std::string("a = 1\nb \0= 2\n", 13),
       "f.toml:2:3: this is not a text file; give a TOML file"},
      {"a = \n",
       "f.toml:1:5: this key-value pair cannot be read: expected value, saw '\\n'; write `key = "
       "value`, texts and quantities in double quotes"},
  };
  for (const auto& [text, sentence] : cases) EXPECT_EQ(refusal(text), sentence);
}

TEST(Document, FilesThatCannotBeReadAreNamed) {
  const auto said = [](const std::string& path) -> std::string {
    try {
      (void)read_toml(path);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(said("no/such.toml"),
            "no/such.toml: cannot be read: No such file or directory; check the path");
  const std::string folder = testing::TempDir();
  EXPECT_EQ(said(folder), folder + ": is not a file; give the path of a file");
}

TEST(Document, ValuesAreShownAsWritten) {
  const Node root = parse_toml(
      "a = 3\nb = 3.0\nc = \"x\"\nd = true\ne = [1]\nf = 9007199254740991\ng = inf\nh = 1979-05-27",
      "f.toml");
  const char* const shown[] = {"3",   "3.0",   "x", "true", "a list", "9007199254740991",
                               "inf", "a date"};
  ASSERT_EQ(root.members.size(), std::size(shown));
  for (std::size_t i = 0; i < std::size(shown); ++i)
    EXPECT_EQ(root.members[i].value.shown(), shown[i]);
}

// --- settings

Node with(const std::string& text, const std::string& assignment) {
  Node root = parse_toml(text, "f.toml");
  const auto [path, value] = parse_assignment(assignment);
  set_value(root, path, value, value.place);
  return root;
}

std::string setting_refusal(const std::string& text, const std::string& assignment) {
  return test::refusal([&] { return with(text, assignment); });
}

TEST(Setting, ReplacesValuesWhereverTheyStand) {
  const std::string text = "a = 1\n[t]\nm = { k = 1 }\n[[step]]\nto = 1\n[[step]]\nto = 2\n";
  EXPECT_EQ(at(with(text, "a=2"), {"a"}).value.number, 2.0);
  EXPECT_EQ(at(with(text, "t.m.k=2"), {"t", "m", "k"}).value.number, 2.0);
  EXPECT_EQ(at(with(text, "t.m={ q = 5 }"), {"t", "m", "q"}).value.number, 5.0);
  EXPECT_EQ(at(with(text, "new.deep.key=2"), {"new", "deep", "key"}).value.number, 2.0);
  const Node root = with(text, "step.2.to=9 mm");
  const Node& second = at(root, {"step"}).value.items[1];
  EXPECT_EQ(at(second, {"to"}).value.text, "9 mm");
  EXPECT_EQ(at(second, {"to"}).value.place, (Place{"--set step.2.to=9 mm", 0, 0}));
  EXPECT_EQ(at(second, {"to"}).place, (Place{"--set step.2.to=9 mm", 0, 0}));
}

TEST(Setting, ValuesAreTomlOrBareText) {
  const auto value = [](const std::string& assignment) {
    return parse_assignment(assignment).second;
  };
  EXPECT_EQ(value("a=5").kind, Node::Kind::integer);
  EXPECT_EQ(value("a= 0.5 ").number, 0.5);
  EXPECT_EQ(value("a=true").boolean, true);
  EXPECT_EQ(value("a=[1, 2]").items.size(), 2U);
  EXPECT_EQ(value("a=\"60 kPa\"").text, "60 kPa");
  EXPECT_EQ(value("a=60 kPa").text, "60 kPa");
  EXPECT_EQ(value("a=hertz").text, "hertz");
  EXPECT_EQ(value("a=").text, "");
  EXPECT_EQ(value("a=b=c").text, "b=c");
  EXPECT_EQ(value("a=1e400").text, "1e400");
  EXPECT_EQ(parse_assignment(" a.b = 1").first, "a.b");
}

// The sentence has the rest.
TEST(Setting, ALongOneIsNamedByItsBeginning) {
  const std::string letters(5000, 'k');
  EXPECT_EQ(parse_assignment(letters + "=1").second.place.file,
            "--set " + letters.substr(0, 200) + "...");
  EXPECT_EQ(parse_assignment("a=" + letters).second.place.file, "--set a");
  const std::string wide = repeated("\u00fc", 150);  // two bytes each
  EXPECT_EQ(parse_assignment(wide + "=1").second.place.file,
            "--set " + wide.substr(0, 200) + "...");
  EXPECT_EQ(parse_assignment("a" + wide + "=1").second.place.file,
            "--set a" + wide.substr(0, 198) + "...");
}

TEST(Setting, TheNumberAfterTheLastAppends) {
  Node root = parse_toml("e = []\n[[step]]\nto = 1\n", "a.toml");
  for (const char* setting : {"step.2.kind=hold", "step.2.time=1 s", "e.1=5", "region.1.kind=slab",
                              "region.1.top=1 mm", "step.3={to = 2}"}) {
    const auto [path, value] = parse_assignment(setting);
    set_value(root, path, value, value.place);
  }
  const Node& steps = root.find("step")->value;
  ASSERT_EQ(steps.items.size(), 3U);
  EXPECT_EQ(steps.items[1].find("kind")->value.text, "hold");
  EXPECT_EQ(steps.items[1].find("time")->value.text, "1 s");
  EXPECT_EQ(steps.items[2].find("to")->value.number, 2.0);
  EXPECT_EQ(root.find("e")->value.items.at(0).number, 5.0);
  const Node& regions = root.find("region")->value;
  EXPECT_EQ(regions.kind, Node::Kind::array);
  EXPECT_EQ(regions.items.at(0).find("top")->value.text, "1 mm");
}

TEST(Setting, WhatCannotBeSetIsRefused) {
  const std::string text = "a = 1\ne = []\n[[step]]\nto = 1\n";
  const std::pair<const char*, const char*> cases[] = {
      {"a", "--set a: a setting is written `key=value`, as `tissue.young_modulus=60 kPa`"},
      {"=1", "--set =1: a setting is written `key=value`, as `tissue.young_modulus=60 kPa`"},
      {"a.b=1",
       "--set a.b=1: `a.b` cannot be set: `b` is looked for inside an integer; name a key "
       "of a table"},
      {"step.2.to=1",
       "--set step.2.to=1: `step.2.to` cannot be set: `2` is none of the list's "
       "entries; count them from 1 to 1, or append one by `2.kind`"},
      {"step.nan.to=1",
       "--set step.nan.to=1: `step.nan.to` cannot be set: `nan` is none of the "
       "list's entries; count them from 1 to 1, or append one by `2.kind`"},
      {"step.to=1",
       "--set step.to=1: `step.to` cannot be set: `to` is none of the list's entries; "
       "count them from 1 to 1, or append one by `2.kind`"},
      {"e.1.to=1",
       "--set e.1.to=1: `e.1.to` cannot be set: `1` is none of the list's entries; append one by "
       "`1.kind`"},
      {"b..c=1",
       "--set b..c=1: `b..c` has an empty word; join the names of tables and a key by "
       "single dots, as `tissue.material`"},
      {"b=\xff", "--set b: the value is not UTF-8 text; write it in UTF-8"},
      {"b=1\nc=2",
       "--set b=1\\x0ac=2: a setting holds one value; write each key with a `--set` of its "
       "own"},
  };
  for (const auto& [assignment, sentence] : cases)
    EXPECT_EQ(setting_refusal(text, assignment), sentence);
  EXPECT_TRUE(setting_refusal(text, "a.b=" + std::string(5000, 'x')).starts_with("--set a.b: "));
}

// --- writing

TEST(DocumentWriter, WritesWhatReadsBack) {
  const std::string text =
      "a = 1\nb = \"say \\\"x\\\"\"\n\n[t]\nm = { k = [1, 2.5], \"x y\" = true }\n"
      "\n[[step]]\nto = 3.0\n\n[[step]]\nto = 2\n";
  EXPECT_EQ(toml_document(parse_toml(text, "f.toml")), text);
}

RC_GTEST_PROP(DocumentWriter, AnyTextReadsBack, (const std::string& any)) {
  std::string text;  // ASCII with its control characters; other bytes are refused as no UTF-8
  for (const char c : any) text += static_cast<char>(c & 0x7f);
  const Node root =
      parse_toml("a = " + toml_text(text) + "\n" + toml_key("_" + text) + " = 1", "f.toml");
  RC_ASSERT(root.members[0].value.text == text);
  RC_ASSERT(root.members[1].key == "_" + text);
}

}  // namespace
}  // namespace palpate
