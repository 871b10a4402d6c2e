#include "files/sdf_tree.h"

#include "sdf_folder.h"

#include <tether/sim/world_parts.h>

namespace tether::sim {
namespace {

std::string bytes_of(const World& world) {
  ByteWriter out;
  out(world);
  return out.take();
}

std::string placing(const std::string& uri, const std::string& how) {
  return "<include>\n<uri>" + uri + "</uri>" + how + "</include>\n";
}

// An attribute makes libsdformat itself read the included file. It takes the <plugin> of an
// <include> for one of the included file's.
TEST(SdfTree, CopiesOfIncludedModelsAreWhatTheLibraryReads) {
  const ScratchFolder folder;
  const std::string shape = "<geometry><box><size>1 2 3</size></box></geometry>";
  folder.write("inner.sdf",
               "<sdf version='1.5'><model name='inner'><pose>0 0 3 0.1 0 0</pose>\n"
               "<plugin name='p' filename='libp.so'><a>1</a></plugin><link name='l'>"
               "<inertial><mass>2</mass></inertial>\n<unknown/><collision name='c'>"
               "<pose>0 1 0 0 0 0</pose>" +
                   shape + "</collision><visual name='v'>" + shape +
                   "<material><diffuse>1 0 0 1</diffuse></material></visual></link>"
                   "</model></sdf>");
  folder.write("nest.sdf",
               "<sdf version='1.7'><model name='nest'><static>1</static>" +
                   placing("inner.sdf", "<name>a</name>") +
                   placing("inner.sdf", "<name>b</name><pose relative_to='a'>1 0 0 0 0 0</pose>") +
                   "</model></sdf>");
  const std::vector<std::string> ways = {
      placing("inner.sdf", ""),
      placing("inner.sdf", ""),
      placing("inner.sdf", "<name>one</name><static>true</static>"),
      placing("inner.sdf", "<name>two</name><pose relative_to='f'>1 2 3 0 0 1</pose>"),
      placing("inner.sdf", "<name>three</name><pose degrees='true'>1 2 3 0 0 90</pose>"),
      placing("inner.sdf", "<name>four</name><pose/><plugin name='q' filename='libq.so'/>"),
      placing("inner.sdf",
              "<name>five</name><pose>1 0 0 0 0 0</pose>"
              "<placement_frame>l</placement_frame>"),
      placing("nest.sdf", "<pose>0 9 0 0 0 0</pose><static>false</static>"),
      placing("nest.sdf", "<name>six</name>")};
  std::vector<std::string> worlds;
  std::vector<std::vector<std::string>> warnings;
  for (const std::string include : {"<include>", "<include merge='false'>"}) {
    std::string content =
        "<model name='m'><frame name='f'><pose>5 0 0 0 0 0</pose></frame>\n"
        "<link name='own'/>";
    for (const std::string& way : ways) content += with(way, "<include>", include);
    const Loaded loaded = load({folder.write("w.sdf", world_sdf(content + "</model>")), {}, {}});
    worlds.push_back(bytes_of(loaded.world));
    auto& lines = warnings.emplace_back();
    for (const Warning& warning : loaded.warnings)
      if (warning.subject != "plugin 'q'") lines.push_back(to_line(warning));
    EXPECT_EQ(loaded.world.models.size(), 1U + 7U + 2U * 3U);
  }
  EXPECT_EQ(worlds.at(0), worlds.at(1));
  EXPECT_EQ(warnings.at(0), warnings.at(1));
}

}  // namespace
}  // namespace tether::sim
