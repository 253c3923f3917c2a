#include "app/force_writer.h"

#include <cmath>
#include <string>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/output.h"
#include "engine/core/text.h"

namespace plumb::app {
namespace {

Vec2d force_of(const ContactReaction& contact) {
  return contact.normal_force * contact.normal + contact.tangent_force * perpendicular(contact.normal);
}

std::string fields(std::initializer_list<std::pair<const char*, double>> numbers) {
  std::string text;
  for (const auto& [key, value] : numbers)
    text += std::string(",\"") + key + "\":" + (std::isfinite(value) ? shortest(value) : "null");
  return text;
}

}  // namespace

ForceWriter::ForceWriter(const Scene& scene, TrajectoryWriter::Format format)
    : scene_(scene), format_(format) {
  if (format == TrajectoryWriter::Format::Csv) print("t,kind,joint,body_a,body_b,x,y,fx,fy,torque\n");
}

void ForceWriter::write(double time, const Reactions& forces) const {
  format_ == TrajectoryWriter::Format::Csv ? write_csv(time, forces) : write_json(time, forces);
}

void ForceWriter::write_csv(double time, const Reactions& forces) const {
  std::string text;
  for (std::size_t i = 0; i < forces.joints.size(); ++i) {
    const JointReaction& joint = forces.joints[i];
    const auto [a, b] =
        std::visit([](const auto& j) { return std::pair(j.body_a, j.body_b); }, scene_.joints[i]);
    text += shortest(time) + ",joint," + csv_text(joint.joint) + "," + csv_text(a) + "," + csv_text(b);
    for (const double value :
         {joint.position.x, joint.position.y, joint.force.x, joint.force.y, joint.torque})
      text += "," + shortest(value);
    text += "\n";
  }
  for (const ContactReaction& contact : forces.contacts) {
    const Vec2d force = force_of(contact);
    text += shortest(time) + ",contact,," + csv_text(scene_.bodies[contact.body_a].name) + "," +
            csv_text(scene_.bodies[contact.body_b].name);
    for (const double value : {contact.position.x, contact.position.y, force.x, force.y})
      text += "," + shortest(value);
    text += ",0\n";
  }
  print(text);
}

void ForceWriter::write_json(double time, const Reactions& forces) const {
  const auto name = [](const std::string& text) { return nlohmann::json(text).dump(); };
  std::string text = "{\"t\":" + shortest(time) + ",\"joints\":[";
  for (std::size_t i = 0; i < forces.joints.size(); ++i) {
    const JointReaction& j = forces.joints[i];
    text += (i == 0 ? "{\"name\":" : ",{\"name\":") + name(j.joint) +
            fields({{"x", j.position.x},
                    {"y", j.position.y},
                    {"fx", j.force.x},
                    {"fy", j.force.y},
                    {"torque", j.torque}}) +
            "}";
  }
  text += "],\"contacts\":[";
  for (std::size_t i = 0; i < forces.contacts.size(); ++i) {
    const ContactReaction& c = forces.contacts[i];
    const Vec2d force = force_of(c);
    text += (i == 0 ? "{\"body_a\":" : ",{\"body_a\":") + name(scene_.bodies[c.body_a].name) +
            ",\"body_b\":" + name(scene_.bodies[c.body_b].name) +
            fields({{"x", c.position.x}, {"y", c.position.y}, {"fx", force.x}, {"fy", force.y}}) + "}";
  }
  print(text + "]}\n");
}

}  // namespace plumb::app
