// A sweep as an array of a real Slurm: controller, node and authentication of this test's own, on
// this machine, on ports of its own, all ended on every way out.
#include <sys/prctl.h>

#include <memory>

#include "sweep_program.h"

namespace palpate::test {
namespace {

constexpr int cases = 32;
constexpr int tasks = 8;

bool installed(const std::string& program) {
  for (const char* folder : {"/usr/sbin/", "/usr/bin/", "/sbin/", "/bin/"})
    if (fs::exists(folder + program)) return true;
  return false;
}

std::string host() {
  char name[256] = {};
  ::gethostname(name, sizeof(name) - 1);
  const std::string full = name;
  return full.substr(0, full.find('.'));
}

class Slurm : public SweepProgram {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "Slurm's daemons run as root";
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue"})
      if (!installed(program)) GTEST_SKIP() << "`" << program << "` is not installed";
    fs::permissions(folder_.path(), fs::perms(0755));
    for (const char* name : {"munge", "state", "spool"}) fs::create_directories(root_ / name);
    write_key();
    write_file(root_ / "slurm.conf", configuration());
    munged_ = start("munged", {"--foreground", "--force", "--key-file", at("munge/key"), "--socket",
                               at("munge/socket"), "--pid-file", at("munge/pid"), "--log-file",
                               at("munge/log"), "--seed-file", at("munge/seed")});
    ASSERT_TRUE(munged_->until([&] { return fs::exists(root_ / "munge/socket"); }))
        << log("munge/log");
    controller_ = start("slurmctld", {"-D", "-f", at("slurm.conf")});
    node_ = start("slurmd", {"-D", "-f", at("slurm.conf"), "-N", host()});
    ASSERT_TRUE(node_->until([&] { return shell("sinfo -h -o %T").out == "idle\n"; }))
        << log("slurmctld.log") << log("slurmd.log");
  }

  void TearDown() override {
    if (controller_) (void)shell("scancel --full --signal=KILL --user=root; scancel --user=root");
    for (auto* daemon : {&node_, &controller_, &munged_}) {
      if (!*daemon) continue;
      (*daemon)->send(SIGTERM);
      // Running kills what does not end.
      (void)(*daemon)->until([&] { return false; });
      daemon->reset();
    }
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (root_ / name).string(); }
  [[nodiscard]] std::string log(const std::string& name) const {
    return fs::exists(root_ / name) ? read_file(root_ / name) : "";
  }

  void write_key() const {
    std::string key(1024, '\0');
    std::ifstream("/dev/urandom", std::ios::binary).read(key.data(), 1024);
    write_file(root_ / "munge/key", key);
    fs::permissions(root_ / "munge/key", fs::perms(0400));
    fs::permissions(root_ / "munge", fs::perms(0755));
  }

  [[nodiscard]] std::string configuration() const {
    const int port = 20000 + 2 * (::getpid() % 10000);
    const std::string name = host();
    return "ClusterName=palpate\nSlurmctldHost=" + name + "(127.0.0.1)\nSlurmUser=root\n" +
           "SlurmctldPort=" + std::to_string(port) + "\nSlurmdPort=" + std::to_string(port + 1) +
           "\nAuthType=auth/munge\nAuthInfo=socket=" + at("munge/socket") +
           "\nStateSaveLocation=" + at("state") + "\nSlurmdSpoolDir=" + at("spool") +
           "\nSlurmctldPidFile=" + at("slurmctld.pid") + "\nSlurmdPidFile=" + at("slurmd.pid") +
           "\nSlurmctldLogFile=" + at("slurmctld.log") + "\nSlurmdLogFile=" + at("slurmd.log") +
           "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
           "JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n"
           "JobCompType=jobcomp/none\nSelectType=select/cons_tres\nSelectTypeParameters=CR_Core\n"
           "SchedulerParameters=batch_sched_delay=0,sched_interval=1\nMpiDefault=none\n"
           "SwitchType=switch/none\nReturnToService=2\nKillWait=5\nMinJobAge=300\n"
           "NodeName=" +
           name +
           " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n"
           "PartitionName=all Nodes=" +
           name + " Default=YES MaxTime=INFINITE State=UP\n";
  }

  [[nodiscard]] std::unique_ptr<Running> start(const std::string& program,
                                               const Words& arguments) const {
    return std::make_unique<Running>(
        Invocation{.arguments = arguments,
                   .folder = root_,
                   .set = {{"SLURM_CONF", at("slurm.conf")}},
                   .before = [] { ::prctl(PR_SET_PDEATHSIG, SIGKILL); },
                   .program = program});
  }
  [[nodiscard]] Ended shell(const std::string& line) const {
    return start("bash", {"-c", line})->wait();
  }

  // Sends what `sweep slurm` prints; returns the job's number.
  std::string send() const {
    const Ended line = sweep({"slurm", plan_, "--chunk", std::to_string(cases / tasks)});
    EXPECT_EQ(line.code, 0) << line.err;
    const Ended sent = shell(line.out);
    EXPECT_TRUE(sent.out.starts_with("Submitted batch job ")) << sent.out << sent.err;
    return sent.out.substr(20, sent.out.size() - 21);
  }
  // A task has begun when it has its lock; who holds it.
  [[nodiscard]] pid_t process_of(int task) const {
    const fs::path lock = folder_ / (plan_ + "/locks/" + std::to_string(task) + "-of-" +
                                     std::to_string(tasks) + ".lock");
    if (!fs::exists(lock)) return 0;
    const std::string who = read_file(lock);  // process 1234 on ...
    return who.starts_with("process ") ? std::atoi(who.c_str() + 8) : 0;
  }
  [[nodiscard]] bool empty_queue() const {
    const Ended queue = shell("squeue --noheader");
    return queue.code == 0 && queue.out.empty();
  }
  // Slurm lets a requeued task wait for two minutes; it is told not to.
  void wait_for_queue(const std::string& requeued = "") {
    for (int i = 0; i < 4 && !empty_queue(); ++i)
      (void)controller_->until([&] {
        if (!requeued.empty()) (void)shell("scontrol update jobid=" + requeued + " starttime=now");
        return empty_queue();
      });
    ASSERT_TRUE(empty_queue()) << shell("squeue --long").out << log("slurmctld.log");
  }

  const std::string plan_ = "the plan/out/s_sweep";  // a folder with a space
  fs::path root_ = folder_ / "slurm";
  std::unique_ptr<Running> munged_, controller_, node_;
};

TEST_F(Slurm, AnArrayWithAKilledAndARequeuedTaskEndsLikeALocalRun) {
  const std::string text = slow_sweep(cases);
  const std::string whole = expected(text);
  write_file(folder_ / "the plan/s.toml", text);
  ASSERT_EQ(palpate(folder_ / "the plan", {"sweep", "plan", "s.toml"}).code, 0);

  const std::string job = send();
  ASSERT_TRUE(controller_->until([&] { return process_of(3) > 0; })) << log("slurmctld.log");
  ::kill(process_of(3), SIGKILL);
  ASSERT_TRUE(controller_->until([&] { return process_of(6) > 0; }));
  const Ended requeued = shell("scontrol requeue " + job + "_6");
  EXPECT_EQ(requeued.code, 0) << requeued.err;
  wait_for_queue(job + "_6");

  const Ended status = sweep({"status", plan_});
  EXPECT_EQ(status.code, 7) << "the task that was killed has left something to do";
  const Ended line = sweep({"slurm", plan_, "--chunk", std::to_string(cases / tasks)});
  EXPECT_TRUE(line.out.starts_with("sbatch --array=3 ")) << line.out;
  (void)send();
  wait_for_queue();

  const Ended merge = sweep({"merge", plan_});
  EXPECT_EQ(merge.code, 0) << merge.err;
  EXPECT_EQ(read_file(folder_ / (plan_ + "/merged/results.csv")), whole);
}

// The other engines of docs/sweeps.md: what they run ends like a local run.
class Engines : public SweepProgram {
 protected:
  void SetUp() override {
    write_file(folder_ / "calm.txt", expected(quick_sweep));
    plan(quick_sweep);
  }
  [[nodiscard]] Ended shell(const std::string& line) const {
    return run_program({.arguments = {"-c", line},
                        .folder = folder_.path(),
                        .set = {{"HOME", folder_.path().string()}},
                        .program = "bash"});
  }
  void expect_the_whole_table() const {
    const Ended merge = sweep({"merge", "out/s_sweep"});
    EXPECT_EQ(merge.code, 0) << merge.err;
    EXPECT_EQ(read_file(folder_ / "out/s_sweep/merged/results.csv"),
              read_file(folder_ / "calm.txt"));
  }
};

TEST_F(Engines, GnuParallelRunsTheParts) {
  if (!installed("parallel")) GTEST_SKIP() << "`parallel` is not installed";
  const std::string program = PALPATE_PROGRAM;
  const Ended ended = shell("'" + program + "' sweep parts out/s_sweep --of 3 | parallel --jobs 2");
  EXPECT_EQ(ended.code, 0) << ended.err;
  expect_the_whole_table();
  EXPECT_EQ(names_in(folder_ / "out/s_sweep/results").size(), 3U);
}

TEST_F(Engines, SnakemakeRunsThePartsThatAreNotDone) {
  if (!installed("snakemake")) GTEST_SKIP() << "`snakemake` is not installed";
  write_file(folder_ / "Snakefile",
             "rule all:\n    input: expand(\"done/{part}\", part=[1, 2, 3])\n"
             "rule part:\n    output: \"done/{part}\"\n"
             "    shell: \"'" +
                 std::string(PALPATE_PROGRAM) +
                 "' sweep run out/s_sweep --shard {wildcards.part}/3 --jobs 1 "
                 "--accept-failed --done {output}\"\n");
  // One part is done already, by hand.
  ASSERT_EQ(sweep({"run", "out/s_sweep", "--shard", "2/3", "--done", "done/2"}).code, 0);
  const Ended ended = shell("/usr/bin/snakemake --cores 2 all");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err.find("/3 --jobs 1 --accept-failed --done done/2"), std::string::npos);
  expect_the_whole_table();
  for (const char* part : {"1", "2", "3"})
    EXPECT_TRUE(read_file(folder_ / "done" / part).starts_with(std::string(part) + "-of-3 of "));
}

}  // namespace
}  // namespace palpate::test
