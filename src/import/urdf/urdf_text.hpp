#pragma once
/// The XML of a URDF with the places of its elements, which urdfdom does not keep.
#include <tinyxml.h>
#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <map>
#include <string>
#include <string_view>

#include "counterflex/files/input_error.hpp"
#include "import/serial_arm.hpp"

namespace counterflex::import {

struct UrdfText {
  std::string file;
  TiXmlDocument document;
  std::map<std::string, const TiXmlElement*> links, joints;  ///< by name; they point into `document`

  UrdfText() = default;
  UrdfText(const UrdfText&) = delete;

  Location place(const TiXmlBase& element) const { return {file, element.Row(), element.Column()}; }
  Location robot() const;
};

/// Reads `text` into `urdf`, without what has no influence on the kinematics: shapes, transmissions,
/// extensions. Throws `InputError` at the element for text that is not XML, xacro, names that are missing or
/// repeated, numbers that are not finite and masses that are negative.
void read_urdf_text(std::string_view text, const std::string& file, UrdfText& urdf);

/// The model that urdfdom builds of it. It prints nothing; its first message is thrown as `InputError`, at
/// the element that it, or a message behind it, names.
urdf::ModelInterfaceSharedPtr parse_urdf(const UrdfText& urdf);

/// Of a joint or an inertial: roll, pitch and yaw as the file has them. (urdfdom keeps a quaternion, whose
/// angles it rounds near a pitch of 90 degrees.)
FixedTransform origin_of(const TiXmlElement& owner);

}  // namespace counterflex::import
