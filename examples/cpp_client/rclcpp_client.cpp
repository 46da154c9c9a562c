// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Ask a paused node for steps, and act on the code of its response, with rclcpp.
//
//   cmake -S examples/cpp_client -B build/cpp_client && cmake --build build/cpp_client
//   build/cpp_client/rclcpp_client /cloth_sim 100

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "cloth_sim_interfaces/msg/result_code.hpp"
#include "cloth_sim_interfaces/srv/step.hpp"
#include "rclcpp/rclcpp.hpp"

using cloth_sim_interfaces::msg::ResultCode;
using cloth_sim_interfaces::srv::Step;
using namespace std::chrono_literals;

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  const std::string name = argc > 1 ? argv[1] : "/cloth_sim";
  const auto request = std::make_shared<Step::Request>();
  request->steps = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 100;
  const auto node = std::make_shared<rclcpp::Node>("cloth_client");
  const auto client = node->create_client<Step>(name + "/step");
  if (!client->wait_for_service(30s)) {
    std::cerr << "cloth_client: no " << name << "/step: start cloth_sim_node, or name it" << std::endl;
    return EXIT_FAILURE;
  }
  auto answer = client->async_send_request(request);
  if (rclcpp::spin_until_future_complete(node, answer, 30s) != rclcpp::FutureReturnCode::SUCCESS) {
    std::cerr << "cloth_client: no response within 30 s" << std::endl;
    return EXIT_FAILURE;
  }
  const auto response = answer.get();
  std::cout << response->message << std::endl;
  if (response->code == ResultCode::WRONG_STATE) {
    std::cout << "pause it first: ros2 service call " << name <<
      "/pause std_srvs/srv/SetBool '{data: true}'" << std::endl;
  }
  rclcpp::shutdown();
  return response->code;
}
