// Faults of the file system on purpose: calls that change files or names are counted, and one of
// them kills the process; the exchange of two folders can be refused, as some file systems do.
#pragma once

namespace palpate::test {

struct FileFaults {
  int kill_before = 0;       // the how-manyth call the process does not survive; 0: it survives all
  bool has_exchange = true;  // whether renameat2() knows RENAME_EXCHANGE
  // So far: open() of a file to write, write(), rename, renameat2, unlink, unlinkat, rmdir, remove,
  // mkdir.
  int calls = 0;
};

// Of this program. A test program links tests/file_faults.cpp, whose functions come before those of
// the C library; another program has them by LD_PRELOAD and takes its faults from the environment
// (PALPATE_TEST_KILL_BEFORE, PALPATE_TEST_NO_EXCHANGE).
extern FileFaults file_faults;

}  // namespace palpate::test
