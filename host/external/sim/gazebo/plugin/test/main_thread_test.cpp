#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

// A main thread that does jobs all the time, as Gazebo's does once it has a scene.
class Drawing {
 public:
  explicit Drawing(MainThread& main)
      : thread_([this, &main] {
          while (!ended_) {
            main.do_jobs();
            std::this_thread::yield();
          }
        }) {}
  ~Drawing() {
    ended_ = true;
    thread_.join();
  }
  std::thread::id id() const { return thread_.get_id(); }

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

TEST(MainThread, DoesTheJobThereBeforeItReturns) {
  MainThread main([] {});
  const Drawing drawing(main);
  std::thread::id id;
  EXPECT_TRUE(main.run([&] { id = std::this_thread::get_id(); }, [] { return false; }));
  EXPECT_EQ(id, drawing.id());
}

TEST(MainThread, HandsOverWhatAJobThrows) {
  MainThread main([] {});
  const Drawing drawing(main);
  const auto fail = [] { throw std::runtime_error("no texture"); };
  EXPECT_THROW(main.run(fail, [] { return false; }), std::runtime_error);
  int done = 0;
  EXPECT_TRUE(main.run([&] { ++done; }, [] { return false; }));
  EXPECT_EQ(done, 1);
}

TEST(MainThread, WakesTheMainThreadUntilItHasCome) {
  int woken = 0;
  MainThread* main = nullptr;
  MainThread woken_third_time([&] {
    if (++woken == 3) main->do_jobs();
  });
  main = &woken_third_time;
  EXPECT_TRUE(main->run([] {}, [] { return false; }));
  EXPECT_EQ(woken, 3);
}

TEST(MainThread, GivesUpAJobThatIsNotBegun) {
  int woken = 0, asked = 0;
  MainThread main([&] { ++woken; });
  bool done = false;
  EXPECT_FALSE(main.run([&] { done = true; }, [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(woken, 3);
  main.do_jobs();
  EXPECT_FALSE(done);
}

}  // namespace
}  // namespace tether::gazebo_plugin
