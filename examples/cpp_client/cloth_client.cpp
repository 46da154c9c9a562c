// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Ask a paused node for steps, and act on the code of its response. rcl is the library below rclcpp,
// and all that ROS from wheels has for C++; the types are those that an rclcpp client has.
//
//   cmake -S examples/cpp_client -B build/cpp_client && cmake --build build/cpp_client
//   build/cpp_client/cloth_client /cloth_sim 100

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>

#include "cloth_sim_interfaces/msg/result_code.hpp"
#include "cloth_sim_interfaces/srv/step.hpp"
#include "rcl/error_handling.h"
#include "rcl/graph.h"
#include "rcl/rcl.h"

using cloth_sim_interfaces::msg::ResultCode;
using cloth_sim_interfaces::srv::Step;

void check(rcl_ret_t ret, const char * what)
{
  if (ret != RCL_RET_OK) {
    throw std::runtime_error(std::string(what) + ": " + rcl_get_error_string().str);
  }
}

// Return the response; throws where none comes within 30 s.
Step::Response ask(const rcl_node_t & node, const rcl_client_t & client, const Step::Request & request)
{
  bool is_asked = false;
  int64_t number = 0;
  for (int tries = 0; tries < 3000; ++tries) {
    bool is_there = false;
    check(rcl_service_server_is_available(&node, &client, &is_there), "looking for the service");
    if (is_there && !is_asked) {
      check(rcl_send_request(&client, &request, &number), "sending the request");
      is_asked = true;
    }
    Step::Response response;
    rmw_request_id_t header;
    if (is_asked && rcl_take_response(&client, &header, &response) == RCL_RET_OK) {
      return response;
    }
    rcl_reset_error();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error("no response: start cloth_sim_node, or name it");
}

int main(int argc, char ** argv)
{
  const std::string name = argc > 1 ? argv[1] : "/cloth_sim";
  Step::Request request;
  request.steps = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 100;
  try {
    rcl_init_options_t options = rcl_get_zero_initialized_init_options();
    check(rcl_init_options_init(&options, rcl_get_default_allocator()), "the options");
    rcl_context_t context = rcl_get_zero_initialized_context();
    check(rcl_init(0, nullptr, &options, &context), "joining the graph");
    rcl_node_t node = rcl_get_zero_initialized_node();
    const rcl_node_options_t node_options = rcl_node_get_default_options();
    check(rcl_node_init(&node, "cloth_client", "", &context, &node_options), "making a node");
    rcl_client_t client = rcl_get_zero_initialized_client();
    const rcl_client_options_t client_options = rcl_client_get_default_options();
    check(
      rcl_client_init(
        &client, &node, rosidl_typesupport_cpp::get_service_type_support_handle<Step>(),
        (name + "/step").c_str(), &client_options), "making a client");
    const Step::Response response = ask(node, client, request);
    std::cout << response.message << std::endl;
    if (response.code == ResultCode::WRONG_STATE) {
      std::cout << "pause it first: ros2 service call " << name <<
        "/pause std_srvs/srv/SetBool '{data: true}'" << std::endl;
    }
    return response.code;
  } catch (const std::exception & error) {
    std::cerr << "cloth_client: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
