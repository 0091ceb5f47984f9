"""Package hexapod_node, as colcon and ament install it."""

from setuptools import find_packages, setup

NAME = 'hexapod_node'

setup(
    name=NAME,
    version='0.1.0',
    description='What every rclpy node of the hexapod shares.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
)
