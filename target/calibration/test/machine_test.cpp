#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/calibration/calibration.h>

namespace tether::calibration {
namespace {

TEST(Machine, IsReadFromProcAndSys) {
  const ScratchFolder folder;
  folder.write("proc/cpuinfo", "processor\t: 0\nmodel name\t: Some CPU\ncpu MHz\t\t: 2100.5\n");
  const std::string root = folder.path().string();
  EXPECT_EQ(read_machine(root).cpu, "Some CPU");
  EXPECT_EQ(read_mhz(1, root), 2100.5);
  folder.write("sys/devices/system/cpu/cpu1/cpufreq/scaling_cur_freq", "1500000\n");
  folder.write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "ondemand\n");
  folder.write("proc/device-tree/model", std::string("Some Board Rev 1.4\0", 19));
  EXPECT_EQ(read_mhz(1, root), 1500.0);
  Machine machine = read_machine(root);
  read_governor(1, machine, root);
  EXPECT_EQ(machine.cpu, "Some Board Rev 1.4") << "says more than its cores";
  EXPECT_EQ(machine.governor, "ondemand");
}

TEST(Machine, UnknownValuesAreEmpty) {
  const ScratchFolder folder;
  const std::string root = folder.path().string();
  Machine machine = read_machine(root);
  read_governor(0, machine, root);
  EXPECT_EQ(machine.cpu, "");
  EXPECT_EQ(machine.governor, "");
  EXPECT_EQ(read_mhz(0, root), 0.0);
  EXPECT_NE(machine.architecture, "");
  EXPECT_GE(machine.cores, 1);
}

}  // namespace
}  // namespace tether::calibration
