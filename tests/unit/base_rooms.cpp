// The house as src/CMakeLists.txt draws it: includes go to rooms above only, a heavy library stays
// behind one .cpp, a file is one thought and says which.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr int longest_file = 400;  // lines; docs/style.md

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

std::vector<std::string> lines_of(const std::string& text) {
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
  for (const std::string& line : lines_of(text)) {
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

// What is wrong with how `files` include one another and the libraries; `rooms` from the top down.
std::vector<std::string> include_faults(const std::vector<SourceFile>& files,
                                        const std::vector<std::string>& rooms) {
  std::vector<std::string> faults;
  std::map<std::string, std::set<std::string>> users;  // of each library, among the .cpp
  const auto rank = [&](const std::string& room) {
    return std::find(rooms.begin(), rooms.end(), room) - rooms.begin();
  };
  const auto unknown = static_cast<std::ptrdiff_t>(rooms.size());

  for (const SourceFile& file : files) {
    const std::string room = room_of(file.path);
    if (rank(room) == unknown) faults.push_back(place(file, 1) + "is in no room of PALPATE_ROOMS");
    for (const Include& include : includes_of(file.text)) {
      const std::string where = place(file, include.line);
      const std::string target = room_of(include.name);
      if (include.quoted && rank(target) == unknown)
        faults.push_back(where + "`" + include.name + "` names no room; write \"room/file.h\"");
      if (include.quoted && rank(target) < unknown && rank(target) > rank(room))
        faults.push_back(where + "`" + room + "` may not use `" + target + "`, which is below it");
      const auto check = [&](const HeavyLibrary& library, bool single) {
        if (!library.owns(include.name)) return;
        if (is_header(file))
          faults.push_back(where + library.name + " may not be included by a header");
        else if (single)
          users[library.name].insert(file.path);
      };
      for (const HeavyLibrary& library : single_file_libraries) check(library, true);
      for (const HeavyLibrary& library : source_only_libraries) check(library, false);
    }
  }
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
    const auto lines = lines_of(file.text);
    if (lines.size() > longest_file)
      faults.push_back(place(file, longest_file + 1) + "is line " +
                       std::to_string(longest_file + 1) + " of " + std::to_string(lines.size()) +
                       "; split the file in two thoughts");
    if (lines.empty() || !lines.front().starts_with("// "))
      faults.push_back(place(file, 1) + "the first line is no comment that says what this is for");
  }
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

// The words of `set(PALPATE_ROOMS ...)`.
std::vector<std::string> rooms_in(const std::string& cmake) {
  const std::string start = "set(PALPATE_ROOMS";
  const auto from = cmake.find(start);
  if (from == std::string::npos) return {};
  const auto to = cmake.find(')', from);
  std::istringstream words(cmake.substr(from + start.size(), to - from - start.size()));
  return {std::istream_iterator<std::string>(words), {}};
}

std::string joined(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += fault + "\n";
  return text;
}

// The emulator is a program of its own: it is judged by itself, and the rooms without it.
const std::vector<std::string> emulator_alone{"emulator"};

struct Programs {
  std::vector<SourceFile> palpate;
  std::vector<SourceFile> emulator;
};

Programs split(const std::vector<SourceFile>& files) {
  Programs programs;
  for (const SourceFile& file : files)
    (room_of(file.path) == emulator_alone.front() ? programs.emulator : programs.palpate)
        .push_back(file);
  return programs;
}

std::string faults_of_programs(const std::vector<SourceFile>& files,
                               const std::vector<std::string>& rooms) {
  const Programs programs = split(files);
  return joined(include_faults(programs.palpate, rooms)) +
         joined(include_faults(programs.emulator, emulator_alone));
}

TEST(Rooms, IncludesGoUpAndHeavyLibrariesStayBehindOneFile) {
  const auto rooms = rooms_in(read_text(source_folder / "CMakeLists.txt"));
  ASSERT_FALSE(rooms.empty()) << "src/CMakeLists.txt no longer sets PALPATE_ROOMS";
  const auto files = our_files();
  ASSERT_FALSE(files.empty());
  EXPECT_FALSE(split(files).emulator.empty());
  EXPECT_EQ(faults_of_programs(files, rooms), "");
}

TEST(Rooms, FilesAreShortAndSayWhatTheyAreFor) { EXPECT_EQ(joined(form_faults(our_files())), ""); }

// The checks themselves, on made-up rooms: each fault is found, and nothing else is.
const std::vector<std::string> made_up_rooms{"base", "contact", "cli"};

std::string faults_of(const std::vector<SourceFile>& files) {
  return joined(include_faults(files, made_up_rooms));
}

TEST(RoomCheck, ReadsTheListOfRooms) {
  EXPECT_EQ(rooms_in("# rooms\nset(PALPATE_ROOMS base\n    contact cli)\nset(above x)"),
            made_up_rooms);
  EXPECT_TRUE(rooms_in("set(OTHER base)").empty());
}

TEST(RoomCheck, LetsAFileUseItsOwnRoomAndThoseAbove) {
  EXPECT_EQ(faults_of({{"cli/verbs.cpp",
                        "#include \"cli/verbs.h\"\n#include \"contact/hertz.h\"\n"
                        "#include \"base/units.h\"\n#include <vector>\n#include <CLI/CLI.hpp>\n"},
                       {"base/document.cpp", "#include <toml++/toml.h>\n"},
                       {"base/units.h", "// text: #include \"cli/verbs.h\"\n"}}),
            "");
}

TEST(RoomCheck, CatchesAnIncludeOfARoomBelow) {
  EXPECT_EQ(faults_of({{"base/units.cpp", "// Units.\n#include \"contact/hertz.h\"\n"}}),
            "src/base/units.cpp:2: `base` may not use `contact`, which is below it\n");
  EXPECT_EQ(faults_of({{"contact/hertz.h", "  #  include \"cli/verbs.h\"  // why not\n"}}),
            "src/contact/hertz.h:1: `contact` may not use `cli`, which is below it\n");
}

TEST(RoomCheck, CatchesAnIncludeOrAFileOutsideTheRooms) {
  EXPECT_EQ(faults_of({{"base/units.cpp", "#include \"units.h\"\n"}}),
            "src/base/units.cpp:1: `units.h` names no room; write \"room/file.h\"\n");
  EXPECT_EQ(faults_of({{"attic/trunk.cpp", "// Old things.\n"}}),
            "src/attic/trunk.cpp:1: is in no room of PALPATE_ROOMS\n");
}

TEST(RoomCheck, KeepsTheEmulatorApart) {
  EXPECT_EQ(
      faults_of_programs({{"emulator/a.cpp", "#include \"emulator/a.h\"\n#include <toml++/t>\n"},
                          {"base/a.cpp", "#include \"base/a.h\"\n#include <toml++/t>\n"}},
                         made_up_rooms),
      "");
  EXPECT_EQ(faults_of_programs({{"emulator/a.cpp", "#include \"base/units.h\"\n"}}, made_up_rooms),
            "src/emulator/a.cpp:1: `base/units.h` names no room; write \"room/file.h\"\n");
  EXPECT_EQ(faults_of_programs({{"cli/a.cpp", "#include \"emulator/a.h\"\n"}}, made_up_rooms),
            "src/cli/a.cpp:1: `emulator/a.h` names no room; write \"room/file.h\"\n");
}

TEST(RoomCheck, CatchesAHeavyHeaderInAHeader) {
  for (const char* heavy :
       {"tetgen.h", "OpenMesh/Core/IO/MeshIO.hh", "ceres/ceres.h", "ImfOutputFile.h",
        "OpenEXR/ImfHeader.h", "toml++/toml.h", "CLI/CLI.hpp", "nlohmann/json.hpp"}) {
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
}

TEST(RoomCheck, CatchesALongFileAndASilentOne) {
  std::string longest = "// As long as a file may be.\n";
  for (int line = 2; line <= longest_file; ++line) longest += "\n";
  EXPECT_EQ(joined(form_faults({{"base/long.h", longest}})), "");
  EXPECT_NE(joined(form_faults({{"base/long.h", longest + "\n"}})), "");
  EXPECT_NE(joined(form_faults({{"base/silent.h", "#pragma once\n"}})), "");
  EXPECT_NE(joined(form_faults({{"base/empty.h", ""}})), "");
}

}  // namespace
