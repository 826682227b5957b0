"""The joints of rigs, skeleton files and trackers by their own names.

On which joint each joint hangs.
"""

import numpy as np
import pytest

from emulator.recordings.joint_names import BLAZEPOSE_33, BODY_25, COCO_17, HALPE_26, joints_of
from emulator.recordings.markers import depths, hung_as_bodies_are, hung_as_in_the_file, without_length
from emulator.skeleton import CANONICAL, EXTRA, Skeleton, standard_skeleton

RIGS = {
    "mixamo": "mixamorig:Hips=pelvis mixamorig:Spine=spine mixamorig:Spine1=chest mixamorig:Spine2=upper_chest "
    "mixamorig:Neck=neck mixamorig:Head=head mixamorig:HeadTop_End= mixamorig:LeftShoulder=left_clavicle "
    "mixamorig:LeftArm=left_shoulder mixamorig:LeftForeArm=left_elbow mixamorig:LeftHand=left_wrist "
    "mixamorig:LeftHandThumb1= mixamorig:LeftHandIndex1=left_hand mixamorig:LeftUpLeg=left_hip "
    "mixamorig:LeftLeg=left_knee mixamorig:LeftFoot=left_ankle mixamorig:LeftToeBase=left_toe mixamorig:LeftToe_End=",
    "cmu bvh": "Hips=pelvis LHipJoint= LeftUpLeg=left_hip LeftLeg=left_knee LeftFoot=left_ankle LeftToeBase=left_toe "
    "LowerBack=spine Spine=chest Spine1=upper_chest Neck=neck Neck1=mid_neck Head=head LeftShoulder=left_clavicle "
    "LeftArm=left_shoulder LeftForeArm=left_elbow LeftHand=left_wrist LeftFingerBase=left_hand LThumb=left_thumb",
    "asf": "root=pelvis lhipjoint=left_hip lfemur=left_knee ltibia=left_ankle lfoot=left_foot ltoes=left_toe "
    "lowerback=spine upperback=chest thorax=neck lowerneck=mid_neck upperneck=upper_neck head=head "
    "lclavicle=left_shoulder lhumerus=left_elbow lradius=left_wrist lwrist= lhand=left_hand lthumb=left_thumb",
    "biped": "Bip01= Bip01_Pelvis=pelvis Bip01_Spine=spine Bip01_Spine1=chest Bip01_Neck=neck Bip01_Head=head "
    "Bip01_L_Clavicle=left_clavicle Bip01_L_UpperArm=left_shoulder Bip01_L_Forearm=left_elbow Bip01_L_Hand=left_wrist "
    "Bip01_R_Thigh=right_hip Bip01_R_Calf=right_knee Bip01_R_Foot=right_ankle Bip01_R_Toe0=right_toe",
    "rokoko": "Hips=pelvis Spine1=spine Spine2= Spine3=chest Spine4=upper_chest Neck=neck Head=head "
    "LeftShoulder=left_clavicle LeftArm=left_shoulder LeftForeArm=left_elbow LeftHand=left_wrist LeftThigh=left_hip "
    "LeftShin=left_knee LeftFoot=left_ankle LeftToe=left_toe",
    "xsens joints": "Hips=pelvis Chest=spine Chest2= Chest3=chest Chest4=upper_chest Neck=neck Head=head "
    "LeftCollar=left_clavicle LeftShoulder=left_shoulder LeftElbow=left_elbow LeftWrist=left_wrist LeftHip=left_hip "
    "LeftKnee=left_knee LeftAnkle=left_ankle LeftToe=left_toe",
    "xsens segments": "Pelvis=pelvis L5=spine L3= T12=chest T8=upper_chest Neck=neck Head=head "
    "RightShoulder=right_clavicle RightUpperArm=right_shoulder RightForeArm=right_elbow RightHand=right_wrist "
    "RightUpperLeg=right_hip RightLowerLeg=right_knee RightFoot=right_ankle RightToe=right_toe",
    "neuron": "Hips=pelvis RightUpLeg=right_hip RightLeg=right_knee RightFoot=right_ankle Spine=spine Spine1= "
    "Spine2=chest Spine3=upper_chest Neck=neck Head=head RightShoulder=right_clavicle RightArm=right_shoulder "
    "RightForeArm=right_elbow RightHand=right_wrist RightInHandIndex=",
    "motive": "Ana:Hip=pelvis Ana:Ab=spine Ana:Chest=chest Ana:Neck=neck Ana:Head=head Ana:LShoulder=left_clavicle "
    "Ana:LUArm=left_shoulder Ana:LFArm=left_elbow Ana:LHand=left_wrist Ana:LThigh=left_hip Ana:LShin=left_knee "
    "Ana:LFoot=left_ankle Ana:LToe=left_toe",
    "bandai": "joint_Root= Hips=pelvis Spine=spine Chest=chest Neck=neck Head=head Shoulder_L=left_clavicle "
    "UpperArm_L=left_shoulder LowerArm_L=left_elbow Hand_L=left_wrist UpperLeg_L=left_hip LowerLeg_L=left_knee "
    "Foot_L=left_ankle Toes_L=left_toe",
    "vrm": "J_Bip_C_Hips=pelvis J_Bip_C_Spine=spine J_Bip_C_Chest=chest J_Bip_C_UpperChest=upper_chest "
    "J_Bip_C_Neck=neck J_Bip_C_Head=head J_Bip_R_Shoulder=right_clavicle J_Bip_R_UpperArm=right_shoulder "
    "J_Bip_R_LowerArm=right_elbow J_Bip_R_Hand=right_wrist J_Bip_R_UpperLeg=right_hip J_Bip_R_LowerLeg=right_knee "
    "J_Bip_R_Foot=right_ankle J_Bip_R_ToeBase=right_toe",
    "unreal": "root= pelvis=pelvis spine_01=spine spine_02=chest spine_03=upper_chest neck_01=neck head=head "
    "clavicle_l=left_clavicle upperarm_l=left_shoulder lowerarm_l=left_elbow hand_l=left_wrist thumb_01_l= "
    "thigh_l=left_hip calf_l=left_knee foot_l=left_ankle ball_l=left_toe lowerarm_twist_01_l=",
    "smpl": "pelvis=pelvis left_hip=left_hip spine1=spine left_knee=left_knee spine2=chest left_ankle=left_ankle "
    "spine3=upper_chest left_foot=left_toe neck=neck left_collar=left_clavicle head=head left_shoulder=left_shoulder "
    "left_elbow=left_elbow left_wrist=left_wrist left_hand=left_hand",
    "kinect": "SpineBase=pelvis SpineMid=spine SpineShoulder=chest Neck=neck Head=head ShoulderLeft=left_shoulder "
    "ElbowLeft=left_elbow WristLeft=left_wrist HandLeft=left_hand HipLeft=left_hip KneeLeft=left_knee "
    "AnkleLeft=left_ankle FootLeft=left_toe HandTipLeft=left_fingers ThumbLeft=left_thumb",
    "human3.6m": "Hip=pelvis RHip=right_hip RKnee=right_knee RFoot=right_ankle Spine=spine Thorax=neck "
    "Head=head RShoulder=right_shoulder RElbow=right_elbow RWrist=right_wrist",
    "old bvh": "Hips=pelvis LeftHip=left_hip LeftKnee=left_knee LeftAnkle=left_ankle LeftAnkle_end=left_toe "
    "Chest=chest Neck=neck Head=head Head_end= LeftCollar=left_clavicle LeftShoulder=left_shoulder "
    "LeftElbow=left_elbow LeftWrist=left_wrist LeftWrist_end=left_hand",
}


@pytest.mark.parametrize("rig", RIGS)
def test_the_joints_of_a_rig_are_known(rig):
    pairs = dict(pair.split("=") for pair in RIGS[rig].split(" "))
    found = [joint if joint in (*CANONICAL, *EXTRA) else "" for joint in joints_of(list(pairs))]
    assert dict(zip(pairs, found)) == pairs


def test_what_all_names_begin_with_is_nobodys_side():
    names = ["pelvis", "left_hip", "right_hip", "neck", "l_knee"]
    for person in ("Ana_", "left handed_", "S-1.", "Rob_Lee_"):
        assert joints_of([person + name for name in names])[:4] == ("pelvis", "left_hip", "right_hip", "neck"), person
    left = ["left_hip", "left_knee", "left_ankle", "left_toe"]
    assert joints_of(left) == tuple(left)


@pytest.mark.parametrize("names", [COCO_17, BODY_25, HALPE_26, BLAZEPOSE_33], ids=len)
def test_every_limb_of_a_tracker_is_known_and_no_point_twice(names):
    found = [joint for joint in joints_of(names) if joint in CANONICAL]
    limbs = [
        f"{side}_{j}" for side in ("left", "right") for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    ]
    assert set(limbs) <= set(found) and len(set(found)) == len(found)


@pytest.mark.parametrize("name", ["", "  ", "left", "l", "R", "_", "marker12", "x" * 1000, "左手", "lower", "right_"])
def test_a_name_that_says_nothing_is_no_joint(name):
    assert joints_of([name]) == ("",)


def test_both_sides_are_read_alike_at_any_place():
    for form in ("{}Shoulder", "{}_shoulder", "shoulder_{}", "shoulder.{}", "{} Shoulder", "Shoulder{}"):
        for word in ("Left", "left", "L", "LEFT"):
            assert joints_of([form.format(word)]) == ("left_shoulder",), form.format(word)
        for word in ("Right", "right", "R"):
            assert joints_of([form.format(word)]) == ("right_shoulder",), form.format(word)


def test_the_canonical_joints_hang_as_in_the_standard_skeleton():
    assert hung_as_bodies_are(CANONICAL) == standard_skeleton().parents


def test_any_part_of_a_body_with_a_pelvis_is_a_tree_with_the_pelvis_as_root():
    rng = np.random.default_rng(0)
    others = [*CANONICAL[1:], *EXTRA]
    for _ in range(200):
        joints = ("pelvis", *rng.choice(others, rng.integers(1, len(others)), replace=False).tolist())
        assert Skeleton(joints, hung_as_bodies_are(joints)).root == 0


def test_a_limb_does_not_hang_on_the_other_side():
    joints = ("pelvis", "left_hip", "right_knee", "right_wrist", "left_shoulder")
    parents = hung_as_bodies_are(joints)
    assert parents == (-1, 0, 0, 0, 0)


def test_children_of_those_left_out_hang_on_the_nearest_ancestor():
    assert hung_as_in_the_file((-1, 0, 1, 2, 3), [0, 2, 4]) == (-1, 0, 1)
    assert hung_as_in_the_file((-1, 0, 1, 0, 3), [2, 4]) is None
    assert depths((-1, 0, 1, 0)) == [0, 1, 2, 1]


def test_a_chain_of_joints_at_one_place_leaves_the_most_needed():
    joints = ("pelvis", "spine", "chest", "neck", "left_hip")
    places = np.zeros((3, 5, 3))
    places[:, 4] = 1.0
    assert sorted(without_length(joints, (-1, 0, 1, 2, 0), places)) == [1, 2, 3]
