// What is measured is kept at once, and only for the same chart.
#include "chart/journal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/files.h"

namespace palpate::chart {
namespace {

namespace fs = std::filesystem;

class JournalOnDisk : public testing::Test {
 protected:
  fs::path root_ = fs::temp_directory_path() / ("palpate-journal-" + std::to_string(::getpid()));
  std::string folder_ = (root_ / "x.partial").string();
  JournalOnDisk() { fs::create_directories(root_); }
  ~JournalOnDisk() override { fs::remove_all(root_); }

  static Measurement measured(const std::string& name) {
    Measurement one;
    one.variant = {1, "rings", name, {"solver.rings=2", "tissue.mesh={kind='tetgen',nodes=9}"}};
    one.status = Status::measured;
    one.model = "mass_spring";
    one.coupling = "consistent";
    one.integrator = "modal";
    one.rings = "2";
    one.substep = 1e-3 / 3.0;
    one.substeps = 3;
    one.nodes = 140;
    one.tetrahedra = 432;
    one.simulated = 0.4;
    one.first_simulated = 0.001;
    one.error = Deviation{0.1, 0.05, 0.0125};
    one.time_floor = 1e-5;
    one.timings = {{0.1, 0.2, 0.3}};
    return one;
  }
};

void expect_same(const Measurement& got, const Measurement& want) {
  EXPECT_EQ(got.variant.name, want.variant.name);
  EXPECT_EQ(got.variant.settings, want.variant.settings);
  EXPECT_EQ(got.status, want.status);
  EXPECT_EQ(got.note, want.note);
  EXPECT_EQ(got.model, want.model);
  EXPECT_EQ(got.coupling, want.coupling);
  EXPECT_EQ(got.integrator, want.integrator);
  EXPECT_EQ(got.rings, want.rings);
  EXPECT_EQ(got.substep, want.substep);
  EXPECT_EQ(got.substeps, want.substeps);
  EXPECT_EQ(got.nodes, want.nodes);
  EXPECT_EQ(got.tetrahedra, want.tetrahedra);
  EXPECT_EQ(got.simulated, want.simulated);
  EXPECT_EQ(got.first_simulated, want.first_simulated);
  ASSERT_EQ(got.error.has_value(), want.error.has_value());
  if (got.error) {
    EXPECT_EQ(got.error->greatest, want.error->greatest);
    EXPECT_EQ(got.error->at_end, want.error->at_end);
    EXPECT_EQ(got.error->rms, want.error->rms);
  }
  ASSERT_EQ(got.time_error.has_value(), want.time_error.has_value());
  if (got.time_error) {
    EXPECT_EQ(got.time_error->rms, want.time_error->rms);
  }
  EXPECT_EQ(got.time_floor, want.time_floor);
  EXPECT_EQ(got.surface_error, want.surface_error);
  ASSERT_EQ(got.timings.size(), want.timings.size());
  for (std::size_t i = 0; i < got.timings.size(); ++i) {
    EXPECT_EQ(got.timings[i].build, want.timings[i].build);
    EXPECT_EQ(got.timings[i].first_row, want.timings[i].first_row);
    EXPECT_EQ(got.timings[i].whole, want.timings[i].whole);
  }
}

TEST_F(JournalOnDisk, EveryTimingIsThereAgain) {
  Measurement one = measured("a, \"quoted\" one");
  Measurement cannot;
  cannot.variant = {0, "base", "b", {}};
  cannot.note = "`b` cannot,\nfor two reasons";
  Measurement timed = measured("c");
  timed.time_error = Deviation{1e-3, 2e-3, 3e-3};
  timed.surface_error = 0.125;
  {
    Journal journal(folder_, "me", Replace::incomplete);
    EXPECT_FALSE(journal.resumed());
    journal.add(one);
    journal.add(cannot);
    one.timings.push_back({0.4, 0.5, 0.6});
    journal.add(one);
    journal.add(timed);
  }
  const Journal again(folder_, "me", Replace::incomplete);
  EXPECT_TRUE(again.resumed());
  expect_same(*again.find(one.variant), one);
  expect_same(*again.find(cannot.variant), cannot);
  expect_same(*again.find(timed.variant), timed);
  EXPECT_FALSE(again.find({0, "rings", "c", {}})) << "another case";
}

TEST_F(JournalOnDisk, ACutLineIsDropped) {
  {
    Journal journal(folder_, "me", Replace::incomplete);
    journal.add(measured("a"));
    journal.add(measured("b"));
  }
  const fs::path file = record::journal_files(folder_).at(0);
  fs::resize_file(file, fs::file_size(file) - 5);
  {
    Journal again(folder_, "me", Replace::incomplete);
    EXPECT_EQ(again.warnings().size(), 1U);
    EXPECT_TRUE(again.find(measured("a").variant));
    EXPECT_FALSE(again.find(measured("b").variant));
    again.add(measured("b"));
  }
  const Journal third(folder_, "me", Replace::incomplete);
  expect_same(*third.find(measured("b").variant), measured("b"));
}

TEST_F(JournalOnDisk, AnotherChartIsNotGoneOnWith) {
  {
    Journal journal(folder_, "me", Replace::incomplete);
    journal.add(measured("a"));
  }
  try {
    const Journal other(folder_, "you", Replace::incomplete);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().message,
              "holds the beginning of a chart of another scenario, other settings or another "
              "version; give another `--out`, or begin afresh with `--force`");
  }
  const Journal forced(folder_, "you", Replace::any);
  EXPECT_FALSE(forced.resumed());
  EXPECT_FALSE(forced.find(measured("a").variant));
}

TEST_F(JournalOnDisk, AForeignFileIsLeftAlone) {
  fs::create_directories(folder_);
  std::ofstream(fs::path(folder_) / "mine.txt") << "mine";
  {
    Journal journal(folder_, "me", Replace::any);
    journal.add(measured("a"));
    journal.remove();
  }
  EXPECT_TRUE(fs::exists(fs::path(folder_) / "mine.txt"));
  EXPECT_TRUE(record::journal_files(folder_).empty());
}

TEST_F(JournalOnDisk, AChartOfAnEarlierVersionIsRefused) {
  fs::create_directories(folder_);
  std::ofstream(fs::path(folder_) / "identity.txt") << "me";
  EXPECT_THROW(Journal(folder_, "me", Replace::incomplete), InputError);
  EXPECT_TRUE(fs::exists(fs::path(folder_) / "identity.txt"));
}

TEST_F(JournalOnDisk, AJournalWithoutRowsLeavesNoFolder) {
  { const Journal journal(folder_, "me", Replace::incomplete); }
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(JournalOnDisk, ReferencesAreKept) {
  const Truth truth{"refined", "a sentence, with a comma", {{1, 0.1, 2.0, 0.3}, {2, 0.2, 1e-9}}};
  {
    Journal journal(folder_, "me", Replace::incomplete);
    EXPECT_TRUE(journal.references().empty());
    journal.add_reference("truth_0", history_table(truth));
    journal.add_reference("in_time_0", history_table({}));
  }
  const Journal again(folder_, "me", Replace::incomplete);
  const Truth got = truth_of(again.references().at("truth_0"));
  EXPECT_EQ(got.kind, truth.kind);
  EXPECT_EQ(got.sentence, truth.sentence);
  ASSERT_EQ(got.moments.size(), 2U);
  EXPECT_EQ(got.moments[0].error, 0.3);
  EXPECT_EQ(got.moments[1].value, 1e-9);
  EXPECT_TRUE(truth_of(again.references().at("in_time_0")).moments.empty());
}

TEST(SurfaceTable, IsReadAsItWasWritten) {
  run::SurfaceReference surface;
  surface.error = 0.1 / 3.0;
  surface.pieces = {{Vec3(1e-3 / 3.0, 0.0, 0.03), Vec3(0.0, 1e-9, -1e-3 / 7.0), 2e-6 / 3.0},
                    {Vec3::Zero(), Vec3::UnitX(), 1.0}};
  const run::SurfaceReference again = surface_of(surface_table(surface));
  EXPECT_EQ(again.error, surface.error);
  ASSERT_EQ(again.pieces.size(), 2U);
  EXPECT_EQ(again.pieces[0].place, surface.pieces[0].place);
  EXPECT_EQ(again.pieces[0].displacement, surface.pieces[0].displacement);
  EXPECT_EQ(again.pieces[0].area, surface.pieces[0].area);
  EXPECT_TRUE(surface_of(surface_table({})).pieces.empty());
}

}  // namespace
}  // namespace palpate::chart
