"""Package hexapod_doe, as colcon and ament install it."""

from setuptools import find_packages, setup

NAME = 'hexapod_doe'

setup(
    name=NAME,
    version='0.1.0',
    description='Designed experiments over sensor sets, from plan to report.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    package_data={
        'hexapod_doe.campaigns': ['templates/*'],
        'hexapod_doe.choosing': ['*.yaml'],
        'hexapod_doe.reporting': ['templates/*'],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    entry_points={
        'console_scripts': [
            'manager_node = hexapod_doe.nodes.executables:manager_node',
            'recorder_node = hexapod_doe.nodes.executables:recorder_node',
            'player_node = hexapod_doe.nodes.executables:player_node',
            'plan = hexapod_doe.plan:main',
            'run_case = hexapod_doe.run_case:main',
            'run_fleet = hexapod_doe.run_fleet:main',
            'analyze = hexapod_doe.analyze:main',
            'follow_report = hexapod_doe.follow_report:main',
            'rescore = hexapod_doe.rescore:main',
            'shadow = hexapod_doe.shadow:main',
            'check_sensors = hexapod_doe.nodes.check_sensors_node:main',
            'campaign_status = hexapod_doe.campaign_status:main',
            'export = hexapod_doe.export:main',
        ],
    },
)
