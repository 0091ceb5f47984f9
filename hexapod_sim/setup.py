"""Package hexapod_sim, as colcon and ament install it."""

from setuptools import find_packages, setup

NAME = 'hexapod_sim'

setup(
    name=NAME,
    version='0.1.0',
    description='MuJoCo model of the hexapod, its sensors and its task.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    package_data={'hexapod_sim': ['*.xml', '*.yaml']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    entry_points={
        'console_scripts': [
            'sim_node = hexapod_sim.nodes.executables:sim_node',
            'fake_driver = hexapod_sim.nodes.executables:fake_driver_node',
        ],
    },
)
