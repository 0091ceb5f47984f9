"""Package ros2_mini, as colcon and ament install it."""

from setuptools import find_packages, setup

NAME = 'ros2_mini'

setup(
    name=NAME,
    version='0.1.0',
    description='A small ros2 command for machines without a ROS 2 install.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    package_data={NAME: ['quick_discovery.xml']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
    ],
    install_requires=['PyYAML', 'numpy', 'setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
)
