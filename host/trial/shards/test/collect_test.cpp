#include "shards_fixture.h"

#include <gmock/gmock.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/shards/shard.h>

namespace tether::shards {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Collect : public ShardsTest {};

TEST_F(Collect, BringsEachResultOnce) {
  const auto a = make_folder("a", {0, 3, 6}), b = make_folder("b", {1, 4, 7}),
             c = make_folder("c", {2, 5});
  const Collected some = collect({out("all"), a, b, c});
  EXPECT_EQ(some.brought, 8u);
  EXPECT_EQ(some.planned, 9u);
  EXPECT_THAT(some.missing, ElementsAre(plans()[8].folder));
  EXPECT_THAT(some.left_out, IsEmpty());
  const Collected rest = collect({out("all"), a, make_folder("d", {8})});
  EXPECT_EQ(rest.brought, 1u);
  EXPECT_THAT(rest.missing, IsEmpty());
  EXPECT_THAT(rest.differing, IsEmpty()) << "a brings the same again";
  EXPECT_THAT(collect({a}).missing, testing::SizeIs(6));
}

TEST_F(Collect, NamesTrialsThatWereFlownTwiceWithOtherResults) {
  const Collected collected = collect({make_folder("a", {0}), make_folder("b", {0}, 5.0)});
  EXPECT_EQ(collected.brought, 0u);
  EXPECT_THAT(collected.differing, ElementsAre(HasSubstr(plans()[0].folder.string())));
  EXPECT_EQ(campaign::read_result(out("a") / plans()[0].folder).metrics[1].value, 4.0);
}

TEST_F(Collect, LeavesOutWhatIsNotOfTheCampaign) {
  const auto a = make_folder("a", {0}, 4.0, {{"tether", "1"}});
  const auto other_version = make_folder("b", {1}, 4.0, {{"tether", "2"}});
  const auto more = make_folder("c", {1}, 4.0, {{"tether", "1"}, {"machine", "m"}});
  campaign_.seeds.push_back(9);
  const auto other_seeds = make_folder("d", {1}, 4.0, {{"tether", "1"}});
  campaign_.name = "other";
  const auto other_name = make_folder("e", {1}, 4.0, {{"tether", "1"}});
  const Collected collected = collect({a, other_version, more, other_seeds, other_name});
  EXPECT_EQ(collected.brought, 0u);
  EXPECT_THAT(collected.left_out,
              ElementsAre(HasSubstr("'tether' is 2, not 1"), HasSubstr("has 'machine' as well"),
                          HasSubstr("has other scenarios, conditions or seeds"),
                          HasSubstr("is of the campaign 'other'")));
}

TEST_F(Collect, NeedsCampaigns) {
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { collect({scratch_.path("none")}); }).subject(),
            scratch_.path("none").string());
  std::filesystem::create_directory(scratch_.path("empty"));
  EXPECT_THROW(collect({make_folder("a", {}), scratch_.path("empty")}), Error);
}

}  // namespace
}  // namespace tether::shards
