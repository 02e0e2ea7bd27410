// Faults of the file system on purpose: one of the calls on files fails or kills the process, reads
// and writes are short, the exchange of two folders is refused, as some file systems do.
#pragma once

namespace palpate::test {

struct FileFaults {
  int kill_before = 0;  // the how-manyth call that changes a file the process does not survive
  int killed = 0;       // the process, not its children, which it answers for; 0: any
  int fail_at = 0;      // the how-manyth call on a file fails; 0: none
  int fail_with = 0;    // errno
  bool stays = false;   // as do all later calls that change a file, but for removals: a full disk
  int most_bytes = 0;   // per read() and write(); 0: any number
  int wait_ms = 0;      // before each call: a slow disk
  bool has_exchange = true;  // whether renameat2() knows RENAME_EXCHANGE
  // So far: open() of a file to write, write(), rename, renameat2, unlink, unlinkat, rmdir, remove,
  // mkdir; and these with open() to read, read() and fsync().
  int changes = 0;
  int calls = 0;
};

// Of this program. A test program links tests/file_faults.cpp, whose functions come before those of
// the C library; another program has them by LD_PRELOAD and takes its faults from the environment:
// PALPATE_TEST_KILL_BEFORE, PALPATE_TEST_FAIL_AT, PALPATE_TEST_FAIL_WITH, PALPATE_TEST_STAYS,
// PALPATE_TEST_MOST_BYTES, PALPATE_TEST_WAIT_MS, PALPATE_TEST_NO_EXCHANGE. A fault leaves
// PALPATE_TEST_MARK.
extern FileFaults file_faults;

}  // namespace palpate::test
