// The rooms as src/CMakeLists.txt states them: a room includes the rooms that it names and no
// others, a heavy library stays behind one .cpp, a file is short and says what it is for, and no
// two types share a name.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr int longest_file = 800;  // lines; docs/style.md

struct SourceFile {
  std::string path;  // below src/, with `/`: "contact/hertz.cpp"
  std::string text;
};

// A library that must stay behind a single .cpp: `owns` says which includes are its own.
struct HeavyLibrary {
  const char* name;
  std::function<bool(std::string_view)> owns;
};

bool is_openexr(std::string_view include) {
  return include.starts_with("Imf") || include.starts_with("OpenEXR/") ||
         include.starts_with("Imath") || include.starts_with("Iex");
}

// One .cpp may include these, and no header of ours.
const std::array single_file_libraries{
    HeavyLibrary{"TetGen", [](std::string_view include) { return include == "tetgen.h"; }},
    HeavyLibrary{"Ceres", [](std::string_view include) { return include.starts_with("ceres/"); }},
    HeavyLibrary{"toml++", [](std::string_view include) { return include.starts_with("toml"); }},
    HeavyLibrary{"OpenEXR", is_openexr},
    HeavyLibrary{"OpenMesh",
                 [](std::string_view include) { return include.starts_with("OpenMesh/"); }},
    HeavyLibrary{"CGAL", [](std::string_view include) { return include.starts_with("CGAL/"); }},
    HeavyLibrary{"Boost.Math",
                 [](std::string_view include) { return include.starts_with("boost/math"); }},
    HeavyLibrary{"Spectra",
                 [](std::string_view include) { return include.starts_with("Spectra/"); }},
    HeavyLibrary{"Beast",
                 [](std::string_view include) {
                   return include.starts_with("boost/asio") || include.starts_with("boost/beast");
                 }},
};

// Any .cpp may include these, but no header of ours.
const std::array source_only_libraries{
    HeavyLibrary{"CLI11", [](std::string_view include) { return include.starts_with("CLI/"); }},
    HeavyLibrary{"nlohmann_json",
                 [](std::string_view include) { return include.starts_with("nlohmann/"); }},
};

bool is_header(const SourceFile& file) { return file.path.ends_with(".h"); }

std::string room_of(const std::string& path) {
  const auto slash = path.find('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

std::vector<std::string> source_lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

struct Include {
  std::string name;
  int line;
  bool quoted;
};

// Every `#include "name"` and `#include <name>`, however it is spaced.
std::vector<Include> includes_of(const std::string& text) {
  std::vector<Include> includes;
  int number = 0;
  for (const std::string& line : source_lines(text)) {
    ++number;
    auto at = line.find_first_not_of(" \t");
    if (at == std::string::npos || line[at] != '#') continue;
    at = line.find_first_not_of(" \t", at + 1);
    if (at == std::string::npos || line.compare(at, 7, "include") != 0) continue;
    at = line.find_first_of("\"<", at);
    if (at == std::string::npos) continue;
    const bool quoted = line[at] == '"';
    const auto end = line.find(quoted ? '"' : '>', at + 1);
    if (end != std::string::npos)
      includes.push_back({line.substr(at + 1, end - at - 1), number, quoted});
  }
  return includes;
}

std::string place(const SourceFile& file, int line) {
  return "src/" + file.path + ":" + std::to_string(line) + ": ";
}

// A room and those that it may include.
struct Room {
  std::string name;
  std::vector<std::string> uses;
  bool operator==(const Room&) const = default;
};

const Room* find_room(const std::vector<Room>& rooms, const std::string& name) {
  const auto found =
      std::find_if(rooms.begin(), rooms.end(), [&](const Room& room) { return room.name == name; });
  return found == rooms.end() ? nullptr : &*found;
}

bool names(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

// What is wrong with the list itself: a room that is listed twice, or names one that does not stand
// before it.
std::vector<std::string> list_faults(const std::vector<Room>& rooms) {
  std::vector<std::string> faults;
  std::vector<std::string> before;
  for (const Room& room : rooms) {
    if (names(before, room.name)) faults.push_back("`" + room.name + "` is listed twice");
    for (const std::string& used : room.uses)
      if (!names(before, used))
        faults.push_back("`" + room.name + "` uses `" + used + "`, which does not stand before it");
    before.push_back(room.name);
  }
  return faults;
}

// Ceres has several forms of problem: one family of files, named ceres_*.cpp.
std::string library_user(const SourceFile& file) {
  const auto name = file.path.substr(file.path.find('/') + 1);
  return name.starts_with("ceres_") ? "ceres_*.cpp" : file.path;
}

// The emulator is a program of its own, with a .cpp of its own for a library.
std::string in_program(const std::string& room) {
  return room == "emulator" ? " in the emulator" : "";
}

// What is wrong with how `files` include one another and the libraries.
std::vector<std::string> include_faults(const std::vector<SourceFile>& files,
                                        const std::vector<Room>& rooms) {
  std::vector<std::string> faults = list_faults(rooms);
  std::map<std::string, std::set<std::string>> users;   // of each library, among the .cpp
  std::map<std::string, std::set<std::string>> needed;  // the rooms that each room includes

  for (const SourceFile& file : files) {
    const Room* room = find_room(rooms, room_of(file.path));
    if (room == nullptr) {
      faults.push_back(place(file, 1) + "is in no room of src/CMakeLists.txt");
      continue;
    }
    for (const Include& include : includes_of(file.text)) {
      const std::string where = place(file, include.line);
      const std::string target = room_of(include.name);
      if (include.quoted) {
        needed[room->name].insert(target);
        if (find_room(rooms, target) == nullptr)
          faults.push_back(where + "`" + include.name + "` names no room; write \"room/file.h\"");
        else if (target != room->name && !names(room->uses, target))
          faults.push_back(where + "`" + room->name + "` does not name `" + target +
                           "` in src/CMakeLists.txt");
      }
      const auto check = [&](const HeavyLibrary& library, bool single) {
        if (!library.owns(include.name)) return;
        if (is_header(file))
          faults.push_back(where + library.name + " may not be included by a header");
        else if (single)
          users[library.name + in_program(room->name)].insert(library_user(file));
      };
      for (const HeavyLibrary& library : single_file_libraries) check(library, true);
      for (const HeavyLibrary& library : source_only_libraries) check(library, false);
    }
  }
  for (const Room& room : rooms)
    for (const std::string& used : room.uses)
      if (!needed[room.name].contains(used))
        faults.push_back("`" + room.name + "` names `" + used + "` and does not include it");
  for (const auto& [library, paths] : users) {
    if (paths.size() < 2) continue;
    std::string fault = library + " may be included by one .cpp only, not by";
    for (const std::string& path : paths) fault += " src/" + path;
    faults.push_back(fault);
  }
  return faults;
}

// What is wrong with the files as texts: too long, or no first line that says what they are for.
std::vector<std::string> form_faults(const std::vector<SourceFile>& files) {
  std::vector<std::string> faults;
  for (const SourceFile& file : files) {
    const auto lines = source_lines(file.text);
    if (lines.size() > longest_file)
      faults.push_back(place(file, longest_file + 1) + "is line " +
                       std::to_string(longest_file + 1) + " of " + std::to_string(lines.size()) +
                       "; split the file in two thoughts");
    if (lines.empty() || !lines.front().starts_with("// "))
      faults.push_back(place(file, 1) + "the first line is no comment that says what this is for");
  }
  return faults;
}

// The text with comments, string literals and preprocessor lines blanked out.
std::string code_of(const std::string& text) {
  static const std::regex other(
      R"re(//[^\n]*|/\*[^]*?\*/|R"(\w*)\([^]*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'|(?:^|\n)[ \t]*#[^\n]*)re",
      std::regex::ECMAScript | std::regex::optimize);
  return std::regex_replace(text, other, "\n");
}

// The qualified names of the types that a file defines at namespace scope, but for those in unnamed
// namespaces, which no other file sees.
std::vector<std::string> types_of(const std::string& text) {
  static const std::regex token(
      R"(namespace\s+([\w:]*)\s*\{|namespace\s*\{|\b(?:struct|class|enum\s+class|enum|union)\s+(?:alignas\(\w+\)\s*)?([\w:]+)[^;{}()=]*\{|[{}])");
  const std::string code = code_of(text);
  struct Scope {
    std::string name;
    bool is_namespace;
    bool hidden;
  };
  std::vector<Scope> scopes;
  std::vector<std::string> types;
  for (std::sregex_iterator at(code.begin(), code.end(), token), end; at != end; ++at) {
    const std::string found = (*at)[0].str();
    if (found == "}") {
      if (!scopes.empty()) scopes.pop_back();
      continue;
    }
    const bool visible = std::all_of(scopes.begin(), scopes.end(), [](const Scope& scope) {
      return scope.is_namespace && !scope.hidden;
    });
    if (found.starts_with("namespace")) {
      const std::string name = (*at)[1].str();
      scopes.push_back({name, true, name.empty()});
      continue;
    }
    if ((*at)[2].matched && visible) {
      std::string name;
      for (const Scope& scope : scopes) name += scope.name + "::";
      types.push_back(name + (*at)[2].str());
    }
    scopes.push_back({"", false, true});
  }
  return types;
}

// Types of one name that two files define: whichever the linker takes, the other file's code is
// undefined behaviour (the one-definition rule).
std::vector<std::string> definition_faults(const std::vector<SourceFile>& files) {
  std::map<std::string, std::string> where;
  std::vector<std::string> faults;
  for (const SourceFile& file : files)
    for (const std::string& type : types_of(file.text))
      if (const auto [first, added] = where.emplace(type, file.path); !added)
        faults.push_back("`" + type + "` is defined by src/" + first->second + " and by src/" +
                         file.path + "; rename one");
  return faults;
}

std::string read_text(const std::filesystem::path& path) {
  const std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

const std::filesystem::path source_folder = std::filesystem::path(PALPATE_SOURCE_DIR) / "src";

std::vector<SourceFile> our_files() {
  std::vector<SourceFile> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder)) {
    const auto extension = entry.path().extension();
    if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
    files.push_back(
        {entry.path().lexically_relative(source_folder).generic_string(), read_text(entry.path())});
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

// The rooms of `palpate_room(NAME USES OTHER...)`, in their order.
std::vector<Room> rooms_in(const std::string& cmake) {
  static const std::regex call(R"((?:^|\n)palpate_room\(([^)]*)\))");
  std::vector<Room> rooms;
  for (std::sregex_iterator at(cmake.begin(), cmake.end(), call), end; at != end; ++at) {
    std::istringstream words((*at)[1].str());
    Room room;
    words >> room.name;
    for (std::string word; words >> word;)
      if (word != "USES") room.uses.push_back(word);
    rooms.push_back(std::move(room));
  }
  return rooms;
}

std::string fault_lines(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += fault + "\n";
  return text;
}

TEST(Rooms, IncludeTheRoomsThatTheyNameAndHeavyLibrariesStayBehindOneFile) {
  const auto rooms = rooms_in(read_text(source_folder / "CMakeLists.txt"));
  ASSERT_GT(rooms.size(), 20U) << "src/CMakeLists.txt no longer lists rooms by palpate_room()";
  EXPECT_EQ(fault_lines(include_faults(our_files(), rooms)), "");
}

// The sections of docs/architecture.md are the rooms, in the same order.
TEST(Rooms, HaveASectionEach) {
  const std::string page =
      read_text(std::filesystem::path(PALPATE_SOURCE_DIR) / "docs/architecture.md");
  std::vector<std::string> sections, rooms;
  for (const std::string& line : source_lines(page))
    if (line.starts_with("### ")) sections.push_back(line.substr(4));
  for (const Room& room : rooms_in(read_text(source_folder / "CMakeLists.txt")))
    rooms.push_back(room.name);
  EXPECT_EQ(sections, rooms);
}

TEST(Rooms, ShareNoTypeName) {
  const auto known = types_of(read_text(source_folder / "geometry/surface.h"));
  EXPECT_TRUE(std::count(known.begin(), known.end(), "palpate::geometry::Surface") == 1)
      << "types are no longer recognised";
  EXPECT_EQ(fault_lines(definition_faults(our_files())), "");
}

TEST(Rooms, FilesAreShortAndSayWhatTheyAreFor) {
  EXPECT_EQ(fault_lines(form_faults(our_files())), "");
}

// The checks themselves, on made-up rooms: each fault is found, and nothing else is.
const std::vector<Room> made_up_rooms{{"base", {}}, {"contact", {"base"}}, {"cli", {"base"}}};
const std::vector<SourceFile> made_up_files{{"base/units.h", "// Units.\n"},
                                            {"contact/hertz.cpp", "#include \"base/units.h\"\n"},
                                            {"cli/main.cpp", "#include \"base/units.h\"\n"}};

std::string faults_of(std::vector<SourceFile> files) {
  files.insert(files.end(), made_up_files.begin(), made_up_files.end());
  return fault_lines(include_faults(files, made_up_rooms));
}

TEST(RoomCheck, ReadsTheListOfRooms) {
  EXPECT_EQ(rooms_in("# palpate_room(none)\nfunction(palpate_room room)\nendfunction()\n"
                     "palpate_room(base)\npalpate_room(contact USES base)\npalpate_room(cli\n"
                     "             USES base)\n"),
            made_up_rooms);
}

TEST(RoomCheck, LetsAFileUseItsOwnRoomAndThoseThatItNames) {
  EXPECT_EQ(faults_of({{"cli/verbs.cpp",
                        "#include \"cli/verbs.h\"\n#include \"base/units.h\"\n"
                        "#include <CLI/CLI.hpp>\n"},
                       {"base/document.cpp", "#include <toml++/toml.h>\n"},
                       {"base/text.h", "// text: #include \"cli/verbs.h\"\n"}}),
            "");
}

TEST(RoomCheck, CatchesAnIncludeOfARoomThatIsNotNamed) {
  EXPECT_EQ(faults_of({{"base/units.cpp", "// Units.\n#include \"contact/hertz.h\"\n"}}),
            "src/base/units.cpp:2: `base` does not name `contact` in src/CMakeLists.txt\n");
  EXPECT_EQ(faults_of({{"cli/verbs.h", "  #  include \"contact/hertz.h\"  // why not\n"}}),
            "src/cli/verbs.h:1: `cli` does not name `contact` in src/CMakeLists.txt\n");
}

TEST(RoomCheck, CatchesAListThatIsNotInOrderOrNotNeeded) {
  const std::vector<Room> circle{{"base", {"cli"}}, {"cli", {"base"}}, {"cli", {}}};
  EXPECT_EQ(fault_lines(list_faults(circle)),
            "`base` uses `cli`, which does not stand before it\n`cli` is listed twice\n");
  EXPECT_EQ(fault_lines(include_faults({}, made_up_rooms)),
            "`contact` names `base` and does not include it\n"
            "`cli` names `base` and does not include it\n");
}

TEST(RoomCheck, CatchesAnIncludeOrAFileOutsideTheRooms) {
  EXPECT_EQ(faults_of({{"base/units.cpp", "#include \"units.h\"\n"}}),
            "src/base/units.cpp:1: `units.h` names no room; write \"room/file.h\"\n");
  EXPECT_EQ(faults_of({{"attic/trunk.cpp", "// Old things.\n"}}),
            "src/attic/trunk.cpp:1: is in no room of src/CMakeLists.txt\n");
}

TEST(RoomCheck, CatchesTwoTypesOfOneName) {
  const std::string row = "namespace palpate::a {\nstruct Row { int x; };\n}\n";
  EXPECT_EQ(fault_lines(definition_faults({{"a/b.h", row}, {"a/c.cpp", row}})),
            "`palpate::a::Row` is defined by src/a/b.h and by src/a/c.cpp; rename one\n");
  EXPECT_EQ(
      fault_lines(definition_faults(
          {{"a/b.h", row},
           {"a/c.cpp", "namespace palpate::b {\nclass Row final : public X {};\n}\n"},
           {"a/d.cpp", "namespace palpate::a {\nnamespace {\nstruct Row {};\n}\n}\n"},
           {"a/e.cpp", "namespace palpate::a { struct Row; struct T { enum class Row {}; }; }"},
           {"a/f.cpp", "// namespace palpate::a { struct Row {}; }\n"},
           {"a/g.cpp", "namespace palpate::a { Row f(struct Row r) { return {}; } }"}})),
      "");
}

TEST(RoomCheck, CatchesAHeavyHeaderInAHeader) {
  for (const char* heavy :
       {"tetgen.h", "OpenMesh/Core/IO/MeshIO.hh", "ceres/ceres.h", "Spectra/SymEigsSolver.h",
        "boost/math/tools/roots.hpp", "ImfOutputFile.h", "OpenEXR/ImfHeader.h", "toml++/toml.h",
        "CLI/CLI.hpp", "nlohmann/json.hpp"}) {
    const std::string include = std::string("#include <") + heavy + ">\n";
    EXPECT_NE(faults_of({{"cli/all.h", include}}), "") << heavy;
    EXPECT_EQ(faults_of({{"cli/all.cpp", include}}), "") << heavy;
  }
}

TEST(RoomCheck, CatchesALibraryInTwoFiles) {
  EXPECT_EQ(
      faults_of({{"contact/a.cpp", "#include <ImfHeader.h>\n#include <ImfOutputFile.h>\n"},
                 {"contact/b.cpp", "#include <OpenEXR/ImfArray.h>\n"}}),
      "OpenEXR may be included by one .cpp only, not by src/contact/a.cpp src/contact/b.cpp\n");
  EXPECT_EQ(faults_of({{"contact/a.cpp", "#include <nlohmann/json.hpp>\n"},
                       {"contact/b.cpp", "#include <nlohmann/json.hpp>\n"}}),
            "");
  const SourceFile one{"base/ceres_a.cpp", "#include <ceres/ceres.h>\n"};
  EXPECT_EQ(faults_of({one, {"contact/ceres_b.cpp", one.text}}), "");
  EXPECT_EQ(faults_of({one, {"base/other.cpp", one.text}}),
            "Ceres may be included by one .cpp only, not by src/base/other.cpp src/ceres_*.cpp\n");
}

TEST(RoomCheck, CatchesALongFileAndASilentOne) {
  std::string longest = "// As long as a file may be.\n";
  for (int line = 2; line <= longest_file; ++line) longest += "\n";
  EXPECT_EQ(fault_lines(form_faults({{"base/long.h", longest}})), "");
  EXPECT_NE(fault_lines(form_faults({{"base/long.h", longest + "\n"}})), "");
  EXPECT_NE(fault_lines(form_faults({{"base/silent.h", "#pragma once\n"}})), "");
  EXPECT_NE(fault_lines(form_faults({{"base/empty.h", ""}})), "");
}

}  // namespace
