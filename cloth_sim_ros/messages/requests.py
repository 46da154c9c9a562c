# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Services and actions of the node, and the topics that it subscribes to."""

from dataclasses import dataclass

from cloth_sim_interfaces.action import MoveFrame as MoveFrameAction
from cloth_sim_interfaces.action import Step as StepAction
from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import FollowFrame
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from geometry_msgs.msg import PointStamped
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Vector3Stamped
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage


@dataclass(frozen=True)
class Request:
    """
    A service, an action, or a topic that the node subscribes to.

    :param name: ~ stands for the name of the node
    :param kind: class of the service, of the action, or of the message
    :param text: one line for people
    """

    name: str
    kind: type
    text: str

    @property
    def type_name(self) -> str:
        """Name of the type, such as std_srvs/srv/Trigger."""
        package, part = self.kind.__module__.split('.')[:2]
        return f'{package}/{part}/{self.kind.__name__}'


SERVICES = (
    Request('~/set_mode', SetMode, 'switch the mode; positions and velocities are kept'),
    Request('~/apply_push', ApplyPush, 'apply a total force to the whole cloth or to the nodes '
            'in a sphere for a duration; returns the number of nodes and the impulse'),
    Request('~/clear_pushes', Trigger, 'cancel all pushes'),
    Request('~/set_pin', SetPin, 'pin or release a node, selected by row and column or as the '
            'one nearest to a point'),
    Request('~/move_pin', MovePin, 'move a pin to a target in a straight line; returns the time '
            'of arrival'),
    Request('~/grasp', Grasp, 'hold free nodes rigidly to a frame; returns their number'),
    Request('~/release', Release, 'release a grasp, or all of them'),
    Request('~/move_grasp', MoveFrame, 'move a grasp in a straight line, and turn it; returns the '
            'time of arrival'),
    Request('~/move_collider', MoveFrame, 'move a collider in a straight line, and turn it; '
            'returns the time of arrival'),
    Request('~/follow_grasp', FollowFrame, 'attach a grasp rigidly to a frame on /tf, or no '
            'longer'),
    Request('~/follow_collider', FollowFrame, 'attach a collider likewise'),
    Request('~/reset', Trigger, 'restore the initial pose, pins and time, and the pushes, grasps '
            'and moves of the scene'),
    Request('~/pause', SetBool, 'pause or resume simulated time'),
    Request('~/step', Step, 'advance a paused simulation by a number of time steps; responds '
            'when they are done'),
    Request('~/start_recording', StartRecording, 'start a recording in `recording.directory`'),
    Request('~/stop_recording', Trigger, 'complete and close the recording'),
)

ACTIONS = (
    Request('~/move_pin', MoveFrameAction, 'move a pin, with feedback, until it has arrived'),
    Request('~/move_grasp', MoveFrameAction, 'move a grasp likewise, and turn it'),
    Request('~/move_collider', MoveFrameAction, 'move a collider likewise, and turn it'),
    Request('~/step', StepAction, 'advance a paused simulation by a number of time steps, with '
            'feedback'),
)

SUBSCRIPTIONS = (
    Request('~/push', Push, 'push the cloth, now or at a later simulated time'),
    Request('~/pins/target', PinTarget, 'stream targets to a pin'),
    Request('~/grasps/NAME/target', PoseStamped, 'stream targets to a grasp, from when it holds '
            'nodes; from the start for those of the scene'),
    Request('~/colliders/NAME/pose', PoseStamped, 'stream targets to a collider'),
    Request('~/wind', Vector3Stamped, 'set the steady wind, if the scene has air'),
    Request('/clicked_point', PointStamped, 'push the cloth around a point clicked in RViz or '
            'Foxglove, as set by the parameters `clicked_point.*`'),
    Request('/tf', TFMessage, 'transforms of the frames in which inputs are given, if '
            '`tf.listen` is true'),
    Request('/tf_static', TFMessage, 'the same, of frames that do not move'),
)
